/* A file system that knows no locks, for LD_PRELOAD: flock fails with the error number in the environment variable NO_LOCKS, for files
   whose path contains the text in NO_LOCKS_FOR, if that is given. */
#define _GNU_SOURCE
#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/syscall.h>
#include <unistd.h>

int flock(int file, int operation) {
  const char* only = getenv("NO_LOCKS_FOR");
  char link[64], path[PATH_MAX] = "";
  snprintf(link, sizeof link, "/proc/self/fd/%d", file);
  if (readlink(link, path, sizeof path - 1) < 0) path[0] = '\0';
  if (only != NULL && strstr(path, only) == NULL) return (int)syscall(SYS_flock, file, operation);
  errno = atoi(getenv("NO_LOCKS"));
  return -1;
}
