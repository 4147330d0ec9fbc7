/* The functions for FMU states; the versions of FMI differ in their names and types only. */
#ifndef STATE_FUNCTIONS_H
#define STATE_FUNCTIONS_H

#include "instance.h"

/*
 * Defines all six functions for one version of FMI, `fmi` being fmi2 or fmi3.
 *
 * Instance, State, Deserialize: the version's spelling of these parts of its names. The file that
 * uses the macro has a struct function for each, of the name without the version.
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
