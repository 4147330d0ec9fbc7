/*
 * FMU states: get, set, free, serialise, deserialise.
 *
 * Bytes that are not a complete state of this build of the FMU are refused.
 */
#include "front.h"
#include "variables.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

struct state {
    struct state *next;
    struct instance *owner;
    fmi2FMUstate slave; /* pythonfmu's */
    uint32_t phase;
    double last_time;
};

enum { MAGIC_SIZE = 8 };

/* Precedes the slave's bytes in a serialised state. */
struct header {
    char magic[MAGIC_SIZE];
    uint64_t check; /* checksum of all that follows */
    char guid[40];
    uint64_t size; /* of the slave's bytes */
    double last_time;
    uint64_t phase;
};

static const char MAGIC[] = "RlvState";
static struct state *states;

static struct state *add_state(struct instance *owner, fmi2FMUstate slave, uint32_t phase,
                               double last_time)
{
    struct state *state = malloc(sizeof *state);
    if (!state)
        return NULL;
    *state = (struct state){.owner = owner, .slave = slave, .phase = phase, .last_time = last_time};
    lock_process();
    state->next = states;
    states = state;
    unlock_process();
    return state;
}

/* True if the pointer is a state of this library that was not freed. */
static bool exists(const void *pointer)
{
    lock_process();
    const struct state *state = states;
    while (state && state != pointer)
        state = state->next;
    unlock_process();
    return state != NULL;
}

static bool is_state(const struct instance *c, const char *function, const void *pointer)
{
    if (!require(c, function, "FMUstate", pointer))
        return false;
    if (!exists(pointer))
        log_message(c, fmi2Error, "%s: FMUstate is no state of this FMU, or was freed", function);
    return exists(pointer);
}

/* Remove the first state from the list that is `pointer` or belongs to `owner`. */
static struct state *remove_state(const void *pointer, const struct instance *owner)
{
    lock_process();
    struct state **place = &states;
    while (*place && *place != pointer && (!owner || (*place)->owner != owner))
        place = &(*place)->next;
    struct state *state = *place;
    if (state)
        *place = state->next;
    unlock_process();
    return state;
}

static void free_state(struct instance *c, struct state *state)
{
    if (c->slave)
        pythonfmu.FreeFMUstate(c->slave, &state->slave);
    free(state);
}

void free_states_of(struct instance *c)
{
    for (struct state *state; (state = remove_state(NULL, c));)
        free_state(c, state);
}

fmi2Status fmi2GetFMUstate(fmi2Component component, fmi2FMUstate *FMUstate)
{
    static const char function[] = "fmi2GetFMUstate";
    struct instance *c = component;
    if (!enter_call(c, function, ANY) || !require(c, function, "FMUstate", FMUstate))
        return fmi2Error;
    fmi2FMUstate slave = NULL;
    fmi2Status status = leave_call(c, pythonfmu.GetFMUstate(c->slave, &slave));
    if (status >= fmi2Error || !slave)
        return fmi2Error;
    /* a state that is passed in is replaced */
    struct state *old = exists(*FMUstate) ? remove_state(*FMUstate, NULL) : NULL;
    if (old)
        free_state(c, old);
    *FMUstate = add_state(c, slave, c->phase, c->last_time);
    return *FMUstate ? status : fmi2Error;
}

fmi2Status fmi2SetFMUstate(fmi2Component component, fmi2FMUstate FMUstate)
{
    struct instance *c = component;
    if (!enter_call(c, "fmi2SetFMUstate", ANY) || !is_state(c, "fmi2SetFMUstate", FMUstate))
        return fmi2Error;
    const struct state *state = FMUstate;
    fmi2Status status = leave_call(c, pythonfmu.SetFMUstate(c->slave, state->slave));
    if (status < fmi2Error) {
        c->phase = state->phase;
        c->last_time = state->last_time;
        c->last_step = fmi2OK;
    }
    return status;
}

fmi2Status fmi2FreeFMUstate(fmi2Component component, fmi2FMUstate *FMUstate)
{
    struct instance *c = component;
    if (!enter_call(c, "fmi2FreeFMUstate", ANY | SLAVE_LOST) ||
        !require(c, "fmi2FreeFMUstate", "FMUstate", FMUstate))
        return fmi2Error;
    if (*FMUstate == NULL)
        return fmi2OK;
    if (!is_state(c, "fmi2FreeFMUstate", *FMUstate))
        return fmi2Error;
    free_state(c, remove_state(*FMUstate, NULL));
    *FMUstate = NULL;
    return fmi2OK;
}

fmi2Status fmi2SerializedFMUstateSize(fmi2Component component, fmi2FMUstate FMUstate, size_t *size)
{
    static const char function[] = "fmi2SerializedFMUstateSize";
    struct instance *c = component;
    if (!enter_call(c, function, ANY) || !is_state(c, function, FMUstate) ||
        !require(c, function, "size", size))
        return fmi2Error;
    fmi2Status status = leave_call(
        c, pythonfmu.SerializedFMUstateSize(c->slave, ((struct state *)FMUstate)->slave, size));
    *size += sizeof(struct header);
    return status;
}

/* FNV-1a, 64 bit: detects bytes that were lost or changed by accident. */
static uint64_t checksum(const char *bytes, size_t size)
{
    uint64_t sum = 14695981039346656037u;
    for (size_t i = 0; i < size; i++)
        sum = (sum ^ (unsigned char)bytes[i]) * 1099511628211u;
    return sum;
}

/* The checksum starts behind `magic` and `check`. */
enum { CHECK_START = MAGIC_SIZE + sizeof(uint64_t) };

fmi2Status fmi2SerializeFMUstate(fmi2Component component, fmi2FMUstate FMUstate,
                                 fmi2Byte serializedState[], size_t size)
{
    static const char function[] = "fmi2SerializeFMUstate";
    struct instance *c = component;
    size_t needed;
    if (!enter_call(c, function, ANY) || !is_state(c, function, FMUstate) ||
        !require(c, function, "serializedState", serializedState))
        return fmi2Error;
    fmi2Status status = fmi2SerializedFMUstateSize(c, FMUstate, &needed);
    if (status >= fmi2Error)
        return status;
    if (size < needed) {
        log_message(c, fmi2Error, "%s: size = %zu bytes is too small, %zu are needed", function,
                    size, needed);
        return fmi2Error;
    }
    const struct state *state = FMUstate;
    struct header header = {.guid = GUID,
                            .size = needed - sizeof header,
                            .last_time = state->last_time,
                            .phase = state->phase};
    memcpy(header.magic, MAGIC, MAGIC_SIZE);
    status =
        leave_call(c, pythonfmu.SerializeFMUstate(c->slave, state->slave,
                                                  serializedState + sizeof header, header.size));
    memcpy(serializedState, &header, sizeof header);
    header.check = checksum(serializedState + CHECK_START, needed - CHECK_START);
    memcpy(serializedState, &header, sizeof header);
    memset(serializedState + needed, 0, size - needed);
    return status;
}

static const char *state_fault(const struct header *header, const char *bytes, size_t size)
{
    if (size < sizeof *header || memcmp(header->magic, MAGIC, MAGIC_SIZE) != 0)
        return "are no state of this FMU";
    if (strncmp(header->guid, GUID, sizeof header->guid) != 0)
        return "are a state of another build or version";
    if (header->size > size - sizeof *header)
        return "are not complete";
    if (header->check != checksum(bytes + CHECK_START, sizeof *header + header->size - CHECK_START))
        return "are damaged";
    if (header->phase != INSTANTIATED && header->phase != INITIALIZING &&
        header->phase != STEPPING && header->phase != TERMINATED)
        return "are damaged";
    return NULL;
}

fmi2Status fmi2DeSerializeFMUstate(fmi2Component component, const fmi2Byte serializedState[],
                                   size_t size, fmi2FMUstate *FMUstate)
{
    static const char function[] = "fmi2DeSerializeFMUstate";
    struct instance *c = component;
    if (!enter_call(c, function, ANY) ||
        !require(c, function, "serializedState", serializedState) ||
        !require(c, function, "FMUstate", FMUstate))
        return fmi2Error;
    struct header header = {.size = 0};
    if (size >= sizeof header)
        memcpy(&header, serializedState, sizeof header);
    const char *fault = state_fault(&header, serializedState, size);
    if (fault) {
        log_message(c, fmi2Error, "%s: the %zu bytes %s", function, size, fault);
        return fmi2Error;
    }
    fmi2FMUstate slave = NULL;
    fmi2Status status =
        leave_call(c, pythonfmu.DeSerializeFMUstate(c->slave, serializedState + sizeof header,
                                                    header.size, &slave));
    if (status >= fmi2Error || !slave)
        return fmi2Error;
    *FMUstate = add_state(c, slave, (uint32_t)header.phase, header.last_time);
    return *FMUstate ? status : fmi2Error;
}
