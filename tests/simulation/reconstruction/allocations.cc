#include "tests/simulation/reconstruction/allocations.h"

#include <cstdlib>

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define FOOTING_COUNTS_ALLOCATIONS 1
namespace {
long allocations = 0;
}
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
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
