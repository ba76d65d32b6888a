#include "tests/simulation/allocations.h"

#include <cstdlib>

// Counts what the C library hands out, so MuJoCo's allocations are seen as well as ours.
#ifndef FOOTING_SANITIZED
#define FOOTING_COUNTS_ALLOCATIONS 1
namespace {
long allocations = 0;
}
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  ++allocations;
  return __libc_calloc(count, size);
}
void* realloc(void* old, std::size_t size) {
  ++allocations;
  return __libc_realloc(old, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  ++allocations;
  return __libc_memalign(alignment, size);
}
}
#endif

namespace footing::test {

#ifdef FOOTING_COUNTS_ALLOCATIONS
bool CountsAllocations() { return true; }
long Allocations() { return allocations; }
#else
bool CountsAllocations() { return false; }
long Allocations() { return 0; }
#endif

}  // namespace footing::test
