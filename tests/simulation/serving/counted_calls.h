#pragma once

#include <atomic>

// Counts what every thread but the test's own takes from the C library: memory, taken or given
// back, and mutexes, which is also what a log would need. A sanitizer brings its own; there the
// tests are skipped.
#ifndef FOOTING_SANITIZED
#define FOOTING_COUNTS_CALLS 1
namespace footing::counted_calls {
extern std::atomic<long> allocations, locks;
extern thread_local bool is_test_thread;
}  // namespace footing::counted_calls
#endif
