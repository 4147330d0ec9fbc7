/* Text: messages, UTF-8. */
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

/* Write `text` with each `character` doubled; what does not fit is cut off. */
void double_character(const char *text, char character, char *to, size_t size);

/* Put ? in the place of every byte that is not UTF-8, as where text was cut within a character. */
void make_utf8(char *text);

/* Decode UTF-8 into `wide`, which may be NULL. Returns false if it is no UTF-8 or does not fit. */
bool decode_utf8(const char *text, wchar_t *wide, size_t size);

#endif
