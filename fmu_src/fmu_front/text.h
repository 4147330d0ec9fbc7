/* Text: messages, UTF-8, file URIs. */
#ifndef TEXT_H
#define TEXT_H

#include "platform.h"

#include <wchar.h>

/* A message to append to. What does not fit is cut off. */
struct message {
    char text[4096];
};

#if defined(__GNUC__)
__attribute__((format(gnu_printf, 2, 3)))
#endif
void append_text(struct message *message, const char *format, ...);

/* Decode UTF-8 into `wide`, which may be NULL. Returns false if it is no UTF-8 or does not fit. */
bool decode_utf8(const char *text, wchar_t *wide, size_t size);

/*
 * Write the FMU's resource folder that a file URI or a plain path names.
 *
 * Takes file:///..., file:/... and every percent-escape. Returns false if no slavemodule.txt is
 * there.
 */
bool resource_folder_of_uri(const char *uri, char folder[PATH_SIZE]);

/* True if pythonfmu's binary can take the path: it decodes only %20 and crashes on some others. */
bool is_plain(const char *path);

#endif
