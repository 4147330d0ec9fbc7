/* platform.h for Windows. The system's functions take paths as UTF-16 with \. */
#define PSAPI_VERSION 2
#include "platform.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <windows.h>

#include <psapi.h>

const char *const PYTHON_LIBRARY = "python3%d.dll";
const char *const STANDARD_LIBRARIES[] = {"%s/Lib/encodings/utf_8.py", "%s/python3%d.zip",
                                          NULL};
const char *const INSTALLED_PYTHON_SOURCE = "registry (PythonCore):";

static HMODULE python; /* the Python library; on Linux and macOS its symbols are global instead */

static bool to_wide(const char *path, wchar_t wide[PATH_SIZE])
{
    if (!MultiByteToWideChar(CP_UTF8, MB_ERR_INVALID_CHARS, path, -1, wide, PATH_SIZE))
        return false;
    for (; *wide; wide++)
        if (*wide == L'/')
            *wide = L'\\';
    return true;
}

static bool to_utf8(const wchar_t *wide, char path[PATH_SIZE])
{
    if (!WideCharToMultiByte(CP_UTF8, 0, wide, -1, path, PATH_SIZE, NULL, NULL))
        return false;
    for (; *path; path++)
        if (*path == '\\')
            *path = '/';
    return true;
}

static bool module_path(HMODULE module, char path[PATH_SIZE])
{
    wchar_t wide[PATH_SIZE];
    DWORD length = GetModuleFileNameW(module, wide, PATH_SIZE);
    return length && length < PATH_SIZE && to_utf8(wide, path);
}

/*
 * Libraries of the limited API need python3.dll, which forwards to python3<minor>.dll. It lies
 * beside the latter, where the loader does not look.
 */
static void make_python_global(HMODULE module)
{
    char path[PATH_SIZE];
    python = module;
    if (module_path(module, path)) {
        char *file = strrchr(path, '/') + 1;
        snprintf(file, (size_t)(path + sizeof path - file), "python3.dll");
        library_open(path, false);
    }
}

void *library_open(const char *path, bool global)
{
    wchar_t wide[PATH_SIZE];
    if (!to_wide(path, wide)) {
        SetLastError(ERROR_INVALID_NAME);
        return NULL;
    }
    /* a library with a path may have its dependencies beside it */
    HMODULE module =
        LoadLibraryExW(wide, NULL, wcschr(wide, L'\\') ? LOAD_WITH_ALTERED_SEARCH_PATH : 0);
    if (module && global)
        make_python_global(module);
    return module;
}

void library_close(void *library)
{
    FreeLibrary(library);
}

void *library_symbol(void *library, const char *name)
{
    return (void *)(INT_PTR)GetProcAddress(library, name);
}

void *process_symbol(const char *name)
{
    return python ? library_symbol(python, name) : NULL;
}

/* The modules of this process that fit in `modules`; returns their number. */
static DWORD loaded_modules(HMODULE modules[], DWORD room)
{
    DWORD size = 0;
    if (!EnumProcessModules(GetCurrentProcess(), modules, room * sizeof *modules, &size))
        return 0;
    DWORD count = size / sizeof *modules;
    return count < room ? count : room;
}

enum { MOST_MODULES = 1024 };

void make_loaded_python_global(void)
{
    HMODULE modules[MOST_MODULES];
    DWORD count = loaded_modules(modules, MOST_MODULES);
    for (DWORD i = 0; i < count; i++) {
        char path[PATH_SIZE];
        int minor, length = 0;
        if (!module_path(modules[i], path) || !strrchr(path, '/'))
            continue;
        const char *file = _strlwr(strrchr(path, '/') + 1);
        if (sscanf(file, "python3%d.dll%n", &minor, &length) == 1 && length && !file[length]) {
            make_python_global(modules[i]);
            return;
        }
    }
}

bool library_is_loaded_below(const char *folder)
{
    HMODULE modules[MOST_MODULES];
    DWORD count = loaded_modules(modules, MOST_MODULES);
    const size_t length = strlen(folder);
    for (DWORD i = 0; i < count; i++) {
        char path[PATH_SIZE];
        if (module_path(modules[i], path) && _strnicmp(path, folder, length) == 0 &&
            path[length] == '/')
            return true;
    }
    return false;
}

bool library_path(const void *address, char path[PATH_SIZE])
{
    HMODULE module;
    DWORD flags =
        GET_MODULE_HANDLE_EX_FLAG_FROM_ADDRESS | GET_MODULE_HANDLE_EX_FLAG_UNCHANGED_REFCOUNT;
    return GetModuleHandleExW(flags, address, &module) && module_path(module, path);
}

bool file_exists(const char *path)
{
    wchar_t wide[PATH_SIZE];
    return to_wide(path, wide) && GetFileAttributesW(wide) != INVALID_FILE_ATTRIBUTES;
}

bool environment_path(const char *name, char value[PATH_SIZE])
{
    wchar_t wide_name[PATH_SIZE], wide[PATH_SIZE];
    if (!to_wide(name, wide_name))
        return false;
    DWORD length = GetEnvironmentVariableW(wide_name, wide, PATH_SIZE);
    return length && length < PATH_SIZE && to_utf8(wide, value);
}

bool installed_python(int oldest, int newest, char path[PATH_SIZE])
{
    for (int minor = newest; minor >= oldest; minor--)
        for (int all_users = 0; all_users < 2; all_users++) {
            wchar_t key[80], folder[PATH_SIZE];
            DWORD size = sizeof folder;
            swprintf(key, sizeof key / sizeof *key,
                     L"Software\\Python\\PythonCore\\3.%d\\InstallPath", minor);
            if (RegGetValueW(all_users ? HKEY_LOCAL_MACHINE : HKEY_CURRENT_USER, key, NULL,
                             RRF_RT_REG_SZ, NULL, folder, &size) ||
                !to_utf8(folder, path))
                continue;
            size_t length = strlen(path);
            snprintf(path + length, PATH_SIZE - length, "%spython3%d.dll",
                     length && path[length - 1] == '/' ? "" : "/", minor);
            if (file_exists(path))
                return true;
        }
    return false;
}

const char *stream_that_is_a_directory(void)
{
    return NULL; /* Windows opens no directories as streams */
}

bool is_in_own_namespace(const void *address)
{
    (void)address; /* Windows has none */
    return false;
}

static HANDLE process_mutex(void)
{
    static HANDLE mutex;
    wchar_t name[40];
    swprintf(name, sizeof name / sizeof *name, L"Local\\rlv_landing_%lu", GetCurrentProcessId());
    if (!mutex) {
        HANDLE made = CreateMutexW(NULL, FALSE, name);
        if (InterlockedCompareExchangePointer(&mutex, made, NULL))
            CloseHandle(made);
    }
    return mutex;
}

void lock_process(void)
{
    WaitForSingleObject(process_mutex(), INFINITE);
}

void unlock_process(void)
{
    ReleaseMutex(process_mutex());
}

/* The setlocale of ucrtbase.dll, which is Python's C library and that of most importers. */
static char *ucrt_locale(const char *name)
{
    HMODULE ucrt = LoadLibraryW(L"ucrtbase.dll");
    char *(*set)(int, const char *);
    *(void **)&set = ucrt ? library_symbol(ucrt, "setlocale") : NULL;
    return set ? set(2 /* LC_CTYPE */, name) : NULL;
}

static char *locale_name;

void save_locale(void)
{
    const char *name = ucrt_locale(NULL);
    locale_name = name ? _strdup(name) : NULL;
}

void restore_locale(void)
{
    if (locale_name)
        ucrt_locale(locale_name);
    free(locale_name);
    locale_name = NULL;
}
