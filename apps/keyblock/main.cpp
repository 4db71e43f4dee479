#include "command_line.h"

#ifdef KEYBLOCK_JEMALLOC
// What jemalloc reads before main(): memory comes in pages of 2 MB where the system has them. In a step, large models touch more pages
// of 4 kB than the processor knows the places of.
extern "C" {
// To be seen from a library.
[[gnu::visibility(
    "default")]] extern const char* malloc_conf;  // NOLINT(readability-identifier-naming): jemalloc's name
const char* malloc_conf = "thp:always";           // NOLINT(readability-identifier-naming)
}
#endif

int main(int argc, char** argv) {
  return keyblock::app::run_command_line(argc, argv);
}
