#include "text.h"

#include <ctype.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void append_text(struct message *message, const char *format, ...)
{
    size_t length = strlen(message->text);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message->text + length, sizeof message->text - length, format, arguments);
    va_end(arguments);
}

bool decode_utf8(const char *text, wchar_t *wide, size_t size)
{
    const unsigned char *s = (const unsigned char *)text;
    size_t n = 0;
    while (*s) {
        int more = *s < 0x80             ? 0
                   : (*s & 0xe0) == 0xc0 ? 1
                   : (*s & 0xf0) == 0xe0 ? 2
                   : (*s & 0xf8) == 0xf0 ? 3
                                         : -1;
        if (more < 0)
            return false;
        uint32_t point = more == 0 ? *s : *s & (0x3fu >> more);
        s++;
        for (int i = 0; i < more; i++, s++) {
            if ((*s & 0xc0) != 0x80)
                return false;
            point = point << 6 | (*s & 0x3fu);
        }
        static const uint32_t shortest[] = {0, 0x80, 0x800, 0x10000};
        if (point < shortest[more] || point > 0x10ffff || (point >= 0xd800 && point < 0xe000))
            return false;
        if (wide) {
            if (n + 2 >= size)
                return false;
#if WCHAR_MAX < 0x10ffff /* UTF-16 */
            if (point > 0xffff) {
                wide[n++] = (wchar_t)(0xd7c0 + (point >> 10));
                point = 0xdc00 | (point & 0x3ff);
            }
#endif
            wide[n++] = (wchar_t)point;
        }
    }
    if (wide)
        wide[n] = L'\0';
    return true;
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

static bool has_slave_module(const char *folder)
{
    char file[PATH_SIZE + 20];
    snprintf(file, sizeof file, "%s/slavemodule.txt", folder);
    return file_exists(file);
}

bool resource_folder_of_uri(const char *uri, char folder[PATH_SIZE])
{
    if (strlen(uri) >= PATH_SIZE)
        return false;
    const char *path = uri;
    if (strncmp(path, "file:", 5) == 0) {
        path += 5;
        if (strncmp(path, "//localhost/", 12) == 0)
            path += 11;
#ifdef _WIN32
        else if (strncmp(path, "///", 3) == 0) /* //server/... is a path there */
            path += 2;
        if (path[0] == '/' && isalpha((unsigned char)path[1]) && path[2] == ':')
            path++;
#else
        else if (strncmp(path, "//", 2) == 0)
            path += 2;
#endif
        decode_percent(path, folder);
        if (has_slave_module(folder))
            return true;
    }
    /* a plain path, or a URI that its host has not escaped */
    memmove(folder, path, strlen(path) + 1);
    return has_slave_module(folder);
}

bool is_plain(const char *path)
{
    for (; *path; path++)
        if (!((*path >= 'a' && *path <= 'z') || (*path >= 'A' && *path <= 'Z') ||
              (*path >= '0' && *path <= '9') || strchr("/._-+~:", *path)))
            return false;
    return true;
}
