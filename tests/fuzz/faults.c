/* A disk that fails, for LD_PRELOAD: the call of the system named in FAULT_CALL fails at its FAULT_AT-th time, and every time after it
   if FAULT_LASTS is set, with the error number FAULT_ERROR. Only files below the folder FAULT_BELOW count. At the end of the process the
   number of calls that counted is written to the file FAULT_COUNT. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <limits.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>
#include <unistd.h>

static atomic_long calls;

static int is_below(const char* path) {
  const char* folder = getenv("FAULT_BELOW");
  char here[PATH_MAX] = "";
  if (path[0] != '/') path = getcwd(here, sizeof here);
  return folder == NULL || path == NULL || strncmp(path, folder, strlen(folder)) == 0;
}

static int is_file_below(int file) {
  char link[64], path[PATH_MAX] = "";
  snprintf(link, sizeof link, "/proc/self/fd/%d", file);
  const ssize_t size = readlink(link, path, sizeof path - 1);
  return size > 0 && is_below(path);
}

/* Whether this call is to fail; errno is set then. */
static int fails(const char* call) {
  const char *wanted = getenv("FAULT_CALL"), *at = getenv("FAULT_AT"), *error = getenv("FAULT_ERROR");
  if (wanted == NULL || strcmp(wanted, call) != 0) return 0;
  const long now = ++calls;
  if (at == NULL || error == NULL) return 0;
  if (now < atol(at) || (now > atol(at) && getenv("FAULT_LASTS") == NULL)) return 0;
  errno = atoi(error);
  return 1;
}

static void __attribute__((destructor)) tell(void) {
  const char* name = getenv("FAULT_COUNT");
  FILE* file = name == NULL ? NULL : fopen(name, "w");
  if (file == NULL) return;
  fprintf(file, "%ld\n", (long)calls);
  fclose(file);
}

#define REAL(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))

ssize_t write(int file, const void* bytes, size_t size) {
  return is_file_below(file) && fails("write") ? -1 : REAL(write)(file, bytes, size);
}

ssize_t pwrite(int file, const void* bytes, size_t size, off_t at) {
  return is_file_below(file) && fails("write") ? -1 : REAL(pwrite)(file, bytes, size, at);
}

ssize_t pwrite64(int file, const void* bytes, size_t size, off64_t at) {
  return is_file_below(file) && fails("write") ? -1 : REAL(pwrite64)(file, bytes, size, at);
}

int fsync(int file) { return is_file_below(file) && fails("fsync") ? -1 : REAL(fsync)(file); }

int fdatasync(int file) { return is_file_below(file) && fails("fsync") ? -1 : REAL(fdatasync)(file); }

int ftruncate(int file, off_t size) {
  return is_file_below(file) && fails("ftruncate") ? -1 : REAL(ftruncate)(file, size);
}

int ftruncate64(int file, off64_t size) {
  return is_file_below(file) && fails("ftruncate") ? -1 : REAL(ftruncate64)(file, size);
}

int rename(const char* from, const char* to) {
  return is_below(to) && fails("rename") ? -1 : REAL(rename)(from, to);
}

int link(const char* from, const char* to) { return is_below(to) && fails("rename") ? -1 : REAL(link)(from, to); }
