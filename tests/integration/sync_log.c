/* For LD_PRELOAD: writes down, in the file that the environment variable SYNC_LOG names, when a file gets its name and when a folder is
   synced. */
#define _GNU_SOURCE
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

static void note(const char* what, const char* path) {
  FILE* log = fopen(getenv("SYNC_LOG"), "a");
  if (log == NULL) return;
  fprintf(log, "%s %s\n", what, path);
  fclose(log);
}

int rename(const char* from, const char* to) {
  note("rename", to);
  return (int)syscall(SYS_rename, from, to);
}

int fsync(int file) {
  char link[64], path[PATH_MAX] = "";
  struct stat status;
  snprintf(link, sizeof link, "/proc/self/fd/%d", file);
  if (readlink(link, path, sizeof path - 1) > 0 && fstat(file, &status) == 0 && S_ISDIR(status.st_mode)) note("sync", path);
  return (int)syscall(SYS_fsync, file);
}
