/*
 * FMU states (FMUstate of FMI 2.0, FMUState of 3.0): get, set, free, serialise, deserialise.
 *
 * Bytes that are not a complete state of this build of the FMU are refused.
 */
#include "instance.h"
#include "variables.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

struct state {
    struct state *next;
    struct instance *owner;
    struct slave_state *slave;
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

/* Add a state of `owner` to the list. It takes over `slave`; NULL if that is NULL or on failure. */
static struct state *add_state(struct instance *owner, struct slave_state *slave, uint32_t phase,
                               double last_time)
{
    struct state *state = slave ? malloc(sizeof *state) : NULL;
    if (!state) {
        if (slave)
            slave_free_state(slave);
        return NULL;
    }
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

static bool is_state(const struct instance *c, const struct function *f, const void *pointer)
{
    if (!require(c, f, "FMUstate", pointer))
        return false;
    bool found = exists(pointer);
    if (!found)
        log_message(c, STATUS_ERROR, "%s: FMUstate is no state of this FMU, or was freed", f->name);
    return found;
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

static void free_state(struct state *state)
{
    slave_free_state(state->slave);
    free(state);
}

void free_states_of(struct instance *c)
{
    for (struct state *state; (state = remove_state(NULL, c));)
        free_state(state);
}

enum status instance_get_state(struct instance *c, const struct function *f, void **state)
{
    struct slave_state *slave;
    if (!enter_call(c, f) || !require(c, f, "FMUstate", state))
        return STATUS_ERROR;
    enum status status = leave_call(c, slave_get_state(c->slave, &slave));
    struct state *made = add_state(c, slave, c->phase, c->last_time);
    if (!made || status >= STATUS_ERROR)
        return STATUS_ERROR;
    /* a state that is passed in is replaced */
    struct state *old = exists(*state) ? remove_state(*state, NULL) : NULL;
    if (old)
        free_state(old);
    *state = made;
    return status;
}

enum status instance_set_state(struct instance *c, const struct function *f, void *state)
{
    if (!enter_call(c, f) || !is_state(c, f, state))
        return STATUS_ERROR;
    const struct state *from = state;
    enum status status = leave_call(c, slave_set_state(c->slave, from->slave));
    if (status < STATUS_ERROR) {
        /* a host that handles no events has no Event Mode: Step Mode instead */
        c->phase = from->phase == EVENT_MODE && !c->host.event_mode ? STEPPING
                                                                    : (enum phase)from->phase;
        c->last_time = from->last_time;
        c->last_step = STATUS_OK;
    }
    return status;
}

enum status instance_free_state(struct instance *c, const struct function *f, void **state)
{
    if (!enter_call(c, f) || !require(c, f, "FMUstate", state))
        return STATUS_ERROR;
    if (*state == NULL)
        return STATUS_OK;
    if (!is_state(c, f, *state))
        return STATUS_ERROR;
    free_state(remove_state(*state, NULL));
    *state = NULL;
    return STATUS_OK;
}

/* The bytes of a state, as the slave writes them. */
static enum status state_bytes(struct instance *c, const struct function *f, struct state *state,
                               const char **bytes, size_t *size)
{
    if (!enter_call(c, f) || !is_state(c, f, state))
        return STATUS_ERROR;
    enum status status = leave_call(c, slave_state_bytes(c->slave, state->slave, bytes, size));
    return *bytes ? status : STATUS_ERROR;
}

enum status instance_state_size(struct instance *c, const struct function *f, void *state,
                                size_t *size)
{
    const char *bytes = NULL;
    size_t length = 0;
    enum status status = state_bytes(c, f, state, &bytes, &length);
    if (status >= STATUS_ERROR || !require(c, f, "size", size))
        return STATUS_ERROR;
    *size = sizeof(struct header) + length;
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

enum status instance_serialize(struct instance *c, const struct function *f, void *state,
                               char bytes[], size_t size)
{
    const char *content = NULL;
    size_t length = 0;
    enum status status = state_bytes(c, f, state, &content, &length);
    if (status >= STATUS_ERROR || !require(c, f, "serializedState", bytes))
        return STATUS_ERROR;
    const struct state *from = state;
    struct header header = {
        .size = length, .last_time = from->last_time, .phase = from->phase};
    memcpy(header.guid, GUID, sizeof header.guid);
    const size_t needed = sizeof header + length;
    if (size < needed) {
        log_message(c, STATUS_ERROR, "%s: size = %zu bytes is too small, %zu are needed", f->name,
                    size, needed);
        return STATUS_ERROR;
    }
    memcpy(header.magic, MAGIC, MAGIC_SIZE);
    memcpy(bytes, &header, sizeof header);
    memcpy(bytes + sizeof header, content, length);
    header.check = checksum(bytes + CHECK_START, needed - CHECK_START);
    memcpy(bytes, &header, sizeof header);
    memset(bytes + needed, 0, size - needed);
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
        header->phase != STEPPING && header->phase != TERMINATED && header->phase != EVENT_MODE)
        return "are damaged";
    return NULL;
}

enum status instance_deserialize(struct instance *c, const struct function *f, const char bytes[],
                                 size_t size, void **state)
{
    if (!enter_call(c, f) || !require(c, f, "serializedState", bytes) ||
        !require(c, f, "FMUstate", state))
        return STATUS_ERROR;
    struct header header = {.size = 0};
    if (size >= sizeof header)
        memcpy(&header, bytes, sizeof header);
    const char *fault = state_fault(&header, bytes, size);
    if (fault) {
        log_message(c, STATUS_ERROR, "%s: the %zu bytes %s", f->name, size, fault);
        return STATUS_ERROR;
    }
    struct slave_state *slave;
    enum status status = leave_call(
        c, slave_state_from_bytes(c->slave, bytes + sizeof header, header.size, &slave));
    struct state *made = add_state(c, slave, (uint32_t)header.phase, header.last_time);
    if (!made || status >= STATUS_ERROR)
        return STATUS_ERROR;
    *state = made;
    return status;
}
