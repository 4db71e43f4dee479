#include "command_line.h"

#ifdef KEYBLOCK_JEMALLOC
// What jemalloc reads before main(). Memory comes in pages of 2 MB where the system has them: in a step, large models touch more pages
// of 4 kB than the processor knows the places of. All threads share one arena: where memory is short, a thread that wants one of its own
// ends the program without a word.
extern "C" {
// To be seen from a library.
[[gnu::visibility(
    "default")]] extern const char* malloc_conf;   // NOLINT(readability-identifier-naming): jemalloc's name
const char* malloc_conf = "thp:always,narenas:1";  // NOLINT(readability-identifier-naming)
}
#endif

int main(int argc, char** argv) {
  return keyblock::app::run_command_line(argc, argv);
}
