// SPDX-License-Identifier: MIT
// A library that a test loads in front of the program (LD_PRELOAD) and that lets one call fail: the N-th that
// asks for memory, or the N-th that reads or writes. OBLIQUE_FAULT says which:
//
//   memory:N   the N-th call of malloc, calloc, realloc, aligned_alloc … of the program gives nothing
//   memory:N+  and so does every later one
//   file:N     the N-th call about a file fails: with EIO, and ENOSPC where it writes
//   pieces:0   every read and write gives or takes a part of what it was asked for, and every other one is
//              interrupted
//   none:0     none
//
// Requests of the code that OBLIQUE_FAULT_SPARED names never fail: "from size from size …", hexadecimal
// numbers, counted from the beginning of the program. Where OBLIQUE_FAULT_COUNTS names a file, the numbers of
// calls are written to it at the end. What the program starts itself is left alone, and so is what happens
// before main: the loader's work. Messages to stderr never fail.
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/types.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

extern "C" {
// The allocator of glibc under the names by which it calls itself.
void* __libc_malloc(size_t size);
void* __libc_calloc(size_t number, size_t size);
void* __libc_realloc(void* block, size_t size);
void* __libc_memalign(size_t alignment, size_t size);
}

namespace {

enum class Kind { none, memory, file, pieces };

Kind kind = Kind::none;
long failing = 0;  // the number of the call, from 1 on
bool from_then_on = false;
std::atomic<bool> counting = false;
std::atomic<long> memory_calls = 0, file_calls = 0, pieces = 0;

// Code whose requests never fail.
struct Code {
  std::uintptr_t from = 0, size = 0;
};
std::array<Code, 32> spared;

bool is_spared(void* caller) {
  for (const Code& code : spared) {
    if (reinterpret_cast<std::uintptr_t>(caller) - code.from < code.size) return true;
  }
  return false;
}

bool memory_fails(void* caller) {
  if (!counting || is_spared(caller)) return false;
  const long number = ++memory_calls;
  if (kind != Kind::memory || (from_then_on ? number < failing : number != failing)) return false;
  errno = ENOMEM;
  return true;
}

bool file_fails(int reason) {
  if (!counting) return false;
  if (++file_calls != failing || kind != Kind::file) return false;
  errno = reason;
  return true;
}

// What a read or write of `size` bytes is cut down to; 0: it is interrupted.
size_t piece_of(size_t size) {
  if (!counting || kind != Kind::pieces || size == 0) return size;
  return ++pieces % 2 == 1 ? 0 : (size + 1) / 2;
}

template <class Function>
Function next(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

using Main = int (*)(int, char**, char**);
Main program_main = nullptr;

void read_request() {
  const char* const fault = std::getenv("OBLIQUE_FAULT");
  if (fault == nullptr) return;
  const char* const number = std::strchr(fault, ':') + 1;
  if (std::strncmp(fault, "memory:", 7) == 0) kind = Kind::memory;
  if (std::strncmp(fault, "file:", 5) == 0) kind = Kind::file;
  if (std::strncmp(fault, "pieces:", 7) == 0) kind = Kind::pieces;
  failing = std::atol(number);
  from_then_on = std::strchr(number, '+') != nullptr;
  unsetenv("LD_PRELOAD");
  const char* text = std::getenv("OBLIQUE_FAULT_SPARED");
  Dl_info program;
  if (text == nullptr || dladdr(reinterpret_cast<void*>(program_main), &program) == 0) return;
  for (Code& code : spared) {
    char* end = nullptr;
    code.from = std::strtoull(text, &end, 16) + reinterpret_cast<std::uintptr_t>(program.dli_fbase);
    code.size = std::strtoull(end, &end, 16);
    text = end;
  }
}

int counted_main(int argc, char** argv, char** environment) {
  read_request();
  counting = true;
  const int status = program_main(argc, argv, environment);
  counting = false;
  return status;
}

struct Counts {
  ~Counts() {
    const char* const path = std::getenv("OBLIQUE_FAULT_COUNTS");
    if (path == nullptr) return;
    std::FILE* const file = next<std::FILE* (*)(const char*, const char*)>("fopen")(path, "w");
    if (file == nullptr) return;
    std::fprintf(file, "%ld %ld\n", memory_calls.load(), file_calls.load());
    std::fclose(file);
  }
} counts;

}  // namespace

extern "C" {

int __libc_start_main(Main main, int argc, char** argv, void (*init)(), void (*fini)(), void (*rtld_fini)(),
                      void* stack_end) {
  using Start = int (*)(Main, int, char**, void (*)(), void (*)(), void (*)(), void*);
  program_main = main;
  return next<Start>("__libc_start_main")(counted_main, argc, argv, init, fini, rtld_fini, stack_end);
}

void* malloc(size_t size) {
  return memory_fails(__builtin_return_address(0)) ? nullptr : __libc_malloc(size);
}
void* calloc(size_t number, size_t size) {
  return memory_fails(__builtin_return_address(0)) ? nullptr : __libc_calloc(number, size);
}
void* realloc(void* block, size_t size) {
  return memory_fails(__builtin_return_address(0)) ? nullptr : __libc_realloc(block, size);
}
void* aligned_alloc(size_t alignment, size_t size) {
  return memory_fails(__builtin_return_address(0)) ? nullptr : __libc_memalign(alignment, size);
}
void* memalign(size_t alignment, size_t size) {
  return memory_fails(__builtin_return_address(0)) ? nullptr : __libc_memalign(alignment, size);
}
int posix_memalign(void** block, size_t alignment, size_t size) {
  if (memory_fails(__builtin_return_address(0))) return ENOMEM;
  *block = __libc_memalign(alignment, size);
  return *block == nullptr ? ENOMEM : 0;
}

int open(const char* path, int flags, ...) {
  if (file_fails(EIO)) return -1;
  __builtin_va_list rest;
  __builtin_va_start(rest, flags);
  const mode_t mode = __builtin_va_arg(rest, mode_t);
  __builtin_va_end(rest);
  return next<int (*)(const char*, int, ...)>("open")(path, flags, mode);
}
std::FILE* fopen(const char* path, const char* mode) {
  return file_fails(EIO) ? nullptr : next<std::FILE* (*)(const char*, const char*)>("fopen")(path, mode);
}
std::FILE* fopen64(const char* path, const char* mode) {
  return fopen(path, mode);
}

ssize_t read(int file, void* bytes, size_t size) {
  if (file_fails(EIO)) return -1;
  const size_t piece = piece_of(size);
  if (piece == 0 && size > 0) {
    errno = EINTR;
    return -1;
  }
  return next<ssize_t (*)(int, void*, size_t)>("read")(file, bytes, piece);
}
ssize_t write(int file, const void* bytes, size_t size) {
  if (file_fails(ENOSPC)) return -1;
  const size_t piece = piece_of(size);
  if (piece == 0 && size > 0) {
    errno = EINTR;
    return -1;
  }
  return next<ssize_t (*)(int, const void*, size_t)>("write")(file, bytes, piece);
}
ssize_t pwrite(int file, const void* bytes, size_t size, off_t offset) {
  if (file_fails(ENOSPC)) return -1;
  const size_t piece = piece_of(size);
  if (piece == 0 && size > 0) {
    errno = EINTR;
    return -1;
  }
  return next<ssize_t (*)(int, const void*, size_t, off_t)>("pwrite")(file, bytes, piece, offset);
}
ssize_t pwrite64(int file, const void* bytes, size_t size, off_t offset) {
  return pwrite(file, bytes, size, offset);
}
int open64(const char* path, int flags, ...) {
  __builtin_va_list rest;
  __builtin_va_start(rest, flags);
  const mode_t mode = __builtin_va_arg(rest, mode_t);
  __builtin_va_end(rest);
  return open(path, flags, mode);
}
int close(int file) {
  const bool fails = file_fails(EIO);  // it is closed all the same, as Linux does
  const int reason = errno;
  const int result = next<int (*)(int)>("close")(file);
  if (!fails) return result;
  errno = reason;
  return -1;
}
int fsync(int file) {
  return file_fails(EIO) ? -1 : next<int (*)(int)>("fsync")(file);
}
int rename(const char* from, const char* to) {
  return file_fails(EIO) ? -1 : next<int (*)(const char*, const char*)>("rename")(from, to);
}
int linkat(int old_folder, const char* from, int new_folder, const char* to, int flags) {
  if (file_fails(ENOSPC)) return -1;
  return next<int (*)(int, const char*, int, const char*, int)>("linkat")(old_folder, from, new_folder, to,
                                                                          flags);
}
int system(const char* command) {
  return file_fails(EAGAIN) ? -1 : next<int (*)(const char*)>("system")(command);
}
char* mkdtemp(char* pattern) {
  return file_fails(ENOSPC) ? nullptr : next<char* (*)(char*)>("mkdtemp")(pattern);
}

// The C library's own calls of write are not seen here: a stream that fails is marked as it would mark it.
size_t fwrite(const void* bytes, size_t size, size_t number, std::FILE* file) {
  if (file != stderr && file_fails(ENOSPC)) {
    file->_flags |= _IO_ERR_SEEN;
    return 0;
  }
  return next<size_t (*)(const void*, size_t, size_t, std::FILE*)>("fwrite")(bytes, size, number, file);
}
int fflush(std::FILE* file) {
  if (file != stderr && file_fails(ENOSPC)) {
    if (file != nullptr) file->_flags |= _IO_ERR_SEEN;
    return EOF;
  }
  return next<int (*)(std::FILE*)>("fflush")(file);
}

}  // extern "C"
