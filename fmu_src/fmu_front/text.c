#include "text.h"

#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

void append_text(struct message *message, const char *format, ...)
{
    size_t length = strlen(message->text);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message->text + length, sizeof message->text - length, format, arguments);
    va_end(arguments);
}

void double_character(const char *text, char character, char *to, size_t size)
{
    for (; *text && size > 2; text++, size--) {
        if (*text == character)
            *to++ = character, size--;
        *to++ = *text;
    }
    *to = '\0';
}

/* Length of the UTF-8 character at `s`, and its code point; 0 if there is none. */
static int character_at(const unsigned char *s, uint32_t *point)
{
    static const uint32_t shortest[] = {0, 0x80, 0x800, 0x10000};
    int more = *s < 0x80             ? 0
               : (*s & 0xe0) == 0xc0 ? 1
               : (*s & 0xf0) == 0xe0 ? 2
               : (*s & 0xf8) == 0xf0 ? 3
                                     : -1;
    if (more < 0)
        return 0;
    *point = more == 0 ? *s : *s & (0x3fu >> more);
    for (int i = 1; i <= more; i++) {
        if ((s[i] & 0xc0) != 0x80)
            return 0;
        *point = *point << 6 | (s[i] & 0x3fu);
    }
    bool exists = *point >= shortest[more] && *point <= 0x10ffff &&
                  !(*point >= 0xd800 && *point < 0xe000);
    return exists ? more + 1 : 0;
}

void make_utf8(char *text)
{
    while (*text) {
        uint32_t point;
        int length = character_at((const unsigned char *)text, &point);
        if (!length)
            *text = '?';
        text += length ? length : 1;
    }
}

bool decode_utf8(const char *text, wchar_t *wide, size_t size)
{
    size_t n = 0;
    while (*text) {
        uint32_t point;
        int length = character_at((const unsigned char *)text, &point);
        if (!length)
            return false;
        text += length;
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
