/* Compiled into a library under -fsanitize-coverage=trace-pc: which of its places a process runs.

   A byte for each byte of the library, 1 where a basic block was entered, in a file that the
   processes share: $C_COVERAGE/LIBRARY. */
#include <fcntl.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/mman.h>

#define BYTES (1 << 22)
#define UNTRACED __attribute__((no_sanitize_coverage))

extern const char __ehdr_start[] __attribute__((visibility("hidden")));
static unsigned char *seen;

__attribute__((constructor)) UNTRACED static void open_map(void)
{
    char path[4096];
    const char *folder = getenv("C_COVERAGE");
    if (!folder)
        return;
    snprintf(path, sizeof path, "%s/%s", folder, LIBRARY);
    int file = open(path, O_RDWR);
    void *map = mmap(0, BYTES, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    seen = map == MAP_FAILED ? 0 : map;
}

UNTRACED void __sanitizer_cov_trace_pc(void)
{
    uintptr_t place = (uintptr_t)__builtin_return_address(0) - (uintptr_t)__ehdr_start;
    if (seen && place < BYTES)
        seen[place] = 1;
}
