/* Preloaded into the program: the n-th call of open (to write), write, rename, renameat2,
 * ftruncate, fsync or mkdir fails, with DSS_FAIL_AT=n and DSS_FAIL_ERRNO (default: ENOSPC). Pipes
 * and terminals are left alone. Calls are counted in each process by itself. With
 * DSS_FAIL_COUNT=FILE the process appends its number of calls there when it ends. With
 * DSS_CLOCK_JUMP=S every other call of clock_gettime(CLOCK_REALTIME) is off by S seconds. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <time.h>
#include <unistd.h>

static atomic_long calls;

static int fails(void) {
  const char* at = getenv("DSS_FAIL_AT");
  const long call = ++calls;
  if (at == NULL || call != atol(at)) return 0;
  const char* number = getenv("DSS_FAIL_ERRNO");
  errno = number != NULL ? atoi(number) : ENOSPC;
  return 1;
}

static int is_file(int descriptor) {
  struct stat status;
  return fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode);
}

__attribute__((destructor)) static void report(void) {
  const char* path = getenv("DSS_FAIL_COUNT");
  FILE* file = path != NULL ? fopen(path, "ae") : NULL;
  if (file == NULL) return;
  fprintf(file, "%ld\n", (long)calls);
  fclose(file);
}

#define NEXT(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))

ssize_t write(int descriptor, const void* bytes, size_t count) {
  if (is_file(descriptor) && fails()) return -1;
  return NEXT(write)(descriptor, bytes, count);
}

int rename(const char* from, const char* to) { return fails() ? -1 : NEXT(rename)(from, to); }

int renameat2(int from_folder, const char* from, int to_folder, const char* to, unsigned flags) {
  return fails() ? -1 : NEXT(renameat2)(from_folder, from, to_folder, to, flags);
}

int ftruncate(int descriptor, off_t length) {
  return fails() ? -1 : NEXT(ftruncate)(descriptor, length);
}

int fsync(int descriptor) { return fails() ? -1 : NEXT(fsync)(descriptor); }

int mkdir(const char* path, mode_t mode) { return fails() ? -1 : NEXT(mkdir)(path, mode); }

int open(const char* path, int flags, ...) {
  mode_t mode = 0;
  if (flags & (O_CREAT | O_TMPFILE)) {
    va_list rest;
    va_start(rest, flags);
    mode = va_arg(rest, mode_t);
    va_end(rest);
  }
  if ((flags & O_ACCMODE) != O_RDONLY && fails()) return -1;
  return NEXT(open)(path, flags, mode);
}

int clock_gettime(clockid_t clock, struct timespec* now) {
  static int (*next)(clockid_t, struct timespec*);
  static atomic_long looks;
  if (next == NULL) next = NEXT(clock_gettime);
  const char* jump = getenv("DSS_CLOCK_JUMP");
  const int result = next(clock, now);
  if (result == 0 && clock == CLOCK_REALTIME && jump != NULL && ++looks % 2 == 0)
    now->tv_sec += atol(jump);
  return result;
}
