/* Built for any x86-64, and run before all that is not: without it, a program that was copied to an older machine dies of an illegal
   instruction. Nothing but system calls, as no function that others are compiled with may be called here. */
#include <string.h>
#include <unistd.h>

#if defined(__x86_64__) && defined(KEYBLOCK_NEEDS_SSE42)
static void say(const char* text) {
  if (write(STDERR_FILENO, text, strlen(text)) < 0) _exit(1);
}

static void need(int is_there, const char* name, const char* remedy) {
  if (is_there) return;
  say("keyblock: this program was built for processors with ");
  say(name);
  say(", which this machine does not have; ");
  say(remedy);
  say("\n");
  _exit(1);
}

static const char build_here[] = "build the program here (./dev build)";

__attribute__((constructor(101))) static void check_processor(void) {
  __builtin_cpu_init();
  need(__builtin_cpu_supports("sse4.2"), "SSE4.2", build_here);
  need(__builtin_cpu_supports("popcnt"), "POPCNT", build_here);
#ifdef KEYBLOCK_NEEDS_AVX2
  need(__builtin_cpu_supports("avx2"), "AVX2", build_here);
  need(__builtin_cpu_supports("fma"), "FMA", build_here);
  need(__builtin_cpu_supports("bmi2"), "BMI2", build_here);
#endif
#ifdef KEYBLOCK_NEEDS_AVX512
  static const char remedy[] =
      "take the package, for processors of 2013 and later, or build the program here (./dev build)";
  need(__builtin_cpu_supports("avx512f"), "AVX-512", remedy);
  need(__builtin_cpu_supports("avx512vl"), "AVX-512 VL", remedy);
#endif
}
#endif
