/* The functions of states, which differ between the versions of FMI in names and types only. */
#ifndef STATE_FUNCTIONS_H
#define STATE_FUNCTIONS_H

#include "instance.h"

/*
 * All six, for a version.
 *
 * Instance, State, Deserialize: how it writes these parts of its names. The file that uses it has a
 * struct function for each, of the name without the version.
 */
#define STATE_FUNCTIONS(fmi, Instance, State, Deserialize) \
    fmi##Status fmi##Get##State(fmi##Instance c, fmi##State *state) \
    { \
        return (fmi##Status)instance_get_state(c, &Get##State, state); \
    } \
    fmi##Status fmi##Set##State(fmi##Instance c, fmi##State state) \
    { \
        return (fmi##Status)instance_set_state(c, &Set##State, state); \
    } \
    fmi##Status fmi##Free##State(fmi##Instance c, fmi##State *state) \
    { \
        return (fmi##Status)instance_free_state(c, &Free##State, state); \
    } \
    fmi##Status fmi##Serialized##State##Size(fmi##Instance c, fmi##State state, size_t *size) \
    { \
        return (fmi##Status)instance_state_size(c, &Serialized##State##Size, state, size); \
    } \
    fmi##Status fmi##Serialize##State(fmi##Instance c, fmi##State state, fmi##Byte bytes[], \
                                      size_t size) \
    { \
        return (fmi##Status)instance_serialize(c, &Serialize##State, state, (char *)bytes, size); \
    } \
    fmi##Status fmi##Deserialize##State(fmi##Instance c, const fmi##Byte bytes[], size_t size, \
                                        fmi##State *state) \
    { \
        return (fmi##Status)instance_deserialize(c, &Deserialize##State, (const char *)bytes, \
                                                 size, state); \
    }

#endif
