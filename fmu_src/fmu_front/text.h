/* Small things with text: growing messages, UTF-8, file URIs. */
#ifndef TEXT_H
#define TEXT_H

#include "platform.h"

#include <wchar.h>

/* A message that is put together piece by piece; what does not fit is left out. */
struct message {
    char text[4096];
};

#if defined(__GNUC__)
__attribute__((format(gnu_printf, 2, 3)))
#endif
void add(struct message *message, const char *format, ...);

/* Decode UTF-8 into `wide` (which may be NULL); false if `text` is not UTF-8 or does not fit. */
bool decode_utf8(const char *text, wchar_t *wide, size_t size);

/* Write the folder that a file URI (file:///..., file:/..., every percent-escape) or a plain path names. */
bool folder_of_uri(const char *uri, char folder[PATH_SIZE]);

/* Whether pythonfmu's binary takes the path as it is: it knows no escape but %20, and dies of some characters. */
bool is_plain(const char *path);

#endif
