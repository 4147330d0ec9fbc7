#include "resources.h"
#include "variables.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* True if `text` begins with the lower-case `start`, whatever its case. */
static bool begins_with(const char *text, const char *start)
{
    while (*start && tolower((unsigned char)*text) == *start)
        text++, start++;
    return *start == '\0';
}

static void decode_percent(const char *from, char *to)
{
    while (*from) {
        if (from[0] == '%' && isxdigit((unsigned char)from[1]) &&
            isxdigit((unsigned char)from[2])) {
            char digits[] = {from[1], from[2], '\0'};
            *to++ = (char)strtol(digits, NULL, 16);
            from += 3;
        } else {
            *to++ = *from++;
        }
    }
    *to = '\0';
}

static bool has_script(const char *folder)
{
    char file[PATH_SIZE + sizeof SLAVE_MODULE + 8];
    snprintf(file, sizeof file, "%s/%s.py", folder, SLAVE_MODULE);
    return file_exists(file);
}

/* Write `path`, or the folder `resources` in it, if the script is there. */
static bool try_folder(const char *path, char folder[PATH_SIZE])
{
    static const char *const formats[] = {"%s", "%s/resources"};
    for (size_t i = 0; i < sizeof formats / sizeof *formats; i++)
        if (snprintf(folder, PATH_SIZE, formats[i], path) < PATH_SIZE && has_script(folder))
            return true;
    return false;
}

/* As try_folder, for a URI's path: its first slash may be missing, or precede a Windows drive. */
static bool try_path(const char *path, char folder[PATH_SIZE])
{
    if (try_folder(path, folder))
        return true;
#ifdef _WIN32
    return try_folder(path + strspn(path, "/"), folder);
#else
    char absolute[PATH_SIZE + 1];
    snprintf(absolute, sizeof absolute, "/%s", path);
    return path[0] != '/' && try_folder(absolute, folder);
#endif
}

bool resources_of_uri(const char *uri, char folder[PATH_SIZE])
{
    char decoded[PATH_SIZE];
    if (!uri || !*uri || strlen(uri) >= PATH_SIZE)
        return false;
    if (!begins_with(uri, "file:"))
        return try_folder(uri, folder);
    const char *path = uri + strlen("file:");
    if (begins_with(path, "//localhost/"))
        path += strlen("//localhost");
#ifndef _WIN32 /* where //server/... is a path */
    else if (begins_with(path, "//"))
        path += strlen("//");
#endif
    decode_percent(path, decoded);
    return try_path(decoded, folder) || try_path(path, folder);
}

bool resources_of_library(char folder[PATH_SIZE])
{
    static const char here;
    char path[PATH_SIZE];
    if (!library_path(&here, path))
        return false;
    for (int i = 0; i < 3; i++) { /* FMU/binaries/PLATFORM/LIBRARY */
        char *end = strrchr(path, '/');
        if (!end)
            return false;
        *end = '\0';
    }
    return try_folder(path, folder);
}
