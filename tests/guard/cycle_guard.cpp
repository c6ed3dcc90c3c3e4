#include "tests/guard/cycle_guard.h"

#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>

#include <dlfcn.h>
#include <fcntl.h>
#include <pthread.h>
#include <sys/uio.h>
#include <unistd.h>

namespace {
thread_local understudy::Calls made;
}  // namespace

namespace understudy {
Calls calls() { return made; }
long allocations() { return made.allocations; }
}  // namespace understudy

#ifdef UNDERSTUDY_SANITIZED

namespace understudy {
bool counts_locks_and_io() { return false; }
}  // namespace understudy

// The sanitizers call this, by this name, at every allocation.
extern "C" void __sanitizer_malloc_hook(const volatile void*, std::size_t) { ++made.allocations; }

#else

namespace understudy {
bool counts_locks_and_io() { return true; }
}  // namespace understudy

namespace {

/// The C library's own function behind the one of the same name here.
template <typename Function>
Function* next(const char* name) {
  void* address = dlsym(RTLD_NEXT, name);
  if (address == nullptr) std::abort();
  return reinterpret_cast<Function*>(address);
}

bool creates_file(int flags) { return (flags & O_CREAT) != 0 || (flags & O_TMPFILE) == O_TMPFILE; }

}  // namespace

extern "C" {

// The C library's allocator by its other names: dlsym itself allocates.
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);

void* malloc(std::size_t size) noexcept {
  ++made.allocations;
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) noexcept {
  ++made.allocations;
  return __libc_calloc(count, size);
}
void* realloc(void* old, std::size_t size) noexcept {
  ++made.allocations;
  return __libc_realloc(old, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  ++made.allocations;
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** place, std::size_t alignment, std::size_t size) noexcept {
  ++made.allocations;
  *place = __libc_memalign(alignment, size);
  return *place == nullptr ? ENOMEM : 0;
}

int pthread_mutex_lock(pthread_mutex_t* mutex) noexcept {
  static auto* const real = next<int(pthread_mutex_t*)>("pthread_mutex_lock");
  ++made.locks;
  return real(mutex);
}
int pthread_mutex_trylock(pthread_mutex_t* mutex) noexcept {
  static auto* const real = next<int(pthread_mutex_t*)>("pthread_mutex_trylock");
  ++made.locks;
  return real(mutex);
}
int pthread_rwlock_rdlock(pthread_rwlock_t* lock) noexcept {
  static auto* const real = next<int(pthread_rwlock_t*)>("pthread_rwlock_rdlock");
  ++made.locks;
  return real(lock);
}
int pthread_rwlock_wrlock(pthread_rwlock_t* lock) noexcept {
  static auto* const real = next<int(pthread_rwlock_t*)>("pthread_rwlock_wrlock");
  ++made.locks;
  return real(lock);
}

int open(const char* path, int flags, ...) {
  static auto* const real = next<int(const char*, int, ...)>("open");
  ++made.io;
  va_list rest;
  va_start(rest, flags);
  const int mode = creates_file(flags) ? va_arg(rest, int) : 0;
  va_end(rest);
  return real(path, flags, mode);
}
int open64(const char* path, int flags, ...) {
  static auto* const real = next<int(const char*, int, ...)>("open64");
  ++made.io;
  va_list rest;
  va_start(rest, flags);
  const int mode = creates_file(flags) ? va_arg(rest, int) : 0;
  va_end(rest);
  return real(path, flags, mode);
}
FILE* fopen(const char* path, const char* mode) {
  static auto* const real = next<FILE*(const char*, const char*)>("fopen");
  ++made.io;
  return real(path, mode);
}
FILE* fopen64(const char* path, const char* mode) {
  static auto* const real = next<FILE*(const char*, const char*)>("fopen64");
  ++made.io;
  return real(path, mode);
}
ssize_t read(int file, void* bytes, std::size_t size) {
  static auto* const real = next<ssize_t(int, void*, std::size_t)>("read");
  ++made.io;
  return real(file, bytes, size);
}
ssize_t write(int file, const void* bytes, std::size_t size) {
  static auto* const real = next<ssize_t(int, const void*, std::size_t)>("write");
  ++made.io;
  return real(file, bytes, size);
}
ssize_t writev(int file, const iovec* parts, int count) {
  static auto* const real = next<ssize_t(int, const iovec*, int)>("writev");
  ++made.io;
  return real(file, parts, count);
}
std::size_t fwrite(const void* bytes, std::size_t size, std::size_t count, FILE* file) {
  static auto* const real = next<std::size_t(const void*, std::size_t, std::size_t, FILE*)>("fwrite");
  ++made.io;
  return real(bytes, size, count, file);
}
int puts(const char* text) {
  static auto* const real = next<int(const char*)>("puts");
  ++made.io;
  return real(text);
}

}  // extern "C"

#endif
