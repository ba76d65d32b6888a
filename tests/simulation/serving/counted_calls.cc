#include "tests/simulation/serving/counted_calls.h"

#include <dlfcn.h>
#include <pthread.h>

#include <cstdlib>

#ifdef FOOTING_COUNTS_CALLS
namespace footing::counted_calls {
std::atomic<long> allocations{0}, locks{0};
thread_local bool is_test_thread = false;
}  // namespace footing::counted_calls

namespace {
using footing::counted_calls::allocations;
using footing::counted_calls::locks;
void Count(std::atomic<long>& calls) {
  if (!footing::counted_calls::is_test_thread) calls.fetch_add(1, std::memory_order_relaxed);
}
}  // namespace
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void __libc_free(void*);
void* malloc(std::size_t size) {
  Count(allocations);
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  Count(allocations);
  return __libc_calloc(count, size);
}
void* realloc(void* old, std::size_t size) {
  Count(allocations);
  return __libc_realloc(old, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  Count(allocations);
  return __libc_memalign(alignment, size);
}
void free(void* memory) {
  if (memory != nullptr) Count(allocations);
  __libc_free(memory);
}
int pthread_mutex_lock(pthread_mutex_t* mutex) noexcept {
  using Lock = int (*)(pthread_mutex_t*);
  static const Lock real = reinterpret_cast<Lock>(dlsym(RTLD_NEXT, "pthread_mutex_lock"));
  Count(locks);
  return real(mutex);
}
}
#endif
