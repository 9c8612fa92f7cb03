#include "harness.hpp"

#include <stdlib.h>

#include <new>

namespace harness {

bool watching = false;
uint64_t allocations = 0;
bool misbehave = false;
Tape* source = nullptr;
Tape* sink = nullptr;

namespace {

void count() {
  if (watching) ++allocations;
}

uint8_t traces[2][kTraceBytes];
uint8_t answers[2][kAnswerBytes];
Tape tapes[] = {{traces[0], kTraceBytes, 0, 0},
                {traces[1], kTraceBytes, 0, 0},
                {answers[0], kAnswerBytes, 0, 0},
                {answers[1], kAnswerBytes, 0, 0}};

[[noreturn]] void give_up(const char* why) {
  fprintf(stderr, "%s\n", why);
  exit(3);
}

}  // namespace

Tape& tape(int number) { return tapes[number]; }

void read_bytes(void* to, size_t size) {
  if (source != nullptr) {
    if (source->size - source->position < size) give_up("a trace ends early");
    memcpy(to, source->bytes + source->position, size);
    source->position += size;
  } else if (fread(to, 1, size, stdin) != size) {
    give_up("a request ends early");
  }
}

void write_bytes(const void* from, size_t size) {
  if (sink != nullptr) {
    if (sink->capacity - sink->size < size) give_up("an answer is too long");
    memcpy(sink->bytes + sink->size, from, size);
    sink->size += size;
  } else if (fwrite(from, 1, size, stdout) != size) {
    give_up("an answer cannot be written");
  }
}

void allocate_once() {
  int* volatile made = new int(1);
  delete made;
  void* volatile block = malloc(1);
  free(block);
}

int serve(const Answer* specs, size_t count, int argc) {
  misbehave = argc > 1;
  uint32_t spec = 0;
  while (fread(&spec, sizeof spec, 1, stdin) == 1) {
    if (spec >= count) give_up("no such spec");
    specs[spec]();
  }
  write(allocations);
  return fflush(stdout) == 0 ? 0 : 3;
}

}  // namespace harness

// ---- counting -----------------------------------------------------------------------------------

void* operator new(size_t size) {
  harness::count();
  return malloc(size == 0 ? 1 : size);
}
void* operator new[](size_t size) { return operator new(size); }
void* operator new(size_t size, const std::nothrow_t&) noexcept { return operator new(size); }
void* operator new[](size_t size, const std::nothrow_t&) noexcept { return operator new(size); }
void operator delete(void* block) noexcept { free(block); }
void operator delete[](void* block) noexcept { free(block); }
void operator delete(void* block, size_t) noexcept { free(block); }
void operator delete[](void* block, size_t) noexcept { free(block); }

#ifdef HARNESS_COUNTS_MALLOC  // not with AddressSanitizer, which replaces these itself
extern "C" {
void* __libc_malloc(size_t size);
void* __libc_calloc(size_t number, size_t size);
void* __libc_realloc(void* block, size_t size);

void* malloc(size_t size) noexcept {
  harness::count();
  return __libc_malloc(size);
}
void* calloc(size_t number, size_t size) noexcept {
  harness::count();
  return __libc_calloc(number, size);
}
void* realloc(void* block, size_t size) noexcept {
  harness::count();
  return __libc_realloc(block, size);
}
}
#endif
