#include <gtest/gtest.h>
#include <stdlib.h>
#include <unistd.h>

#include <cstring>

/// The testbed sends uevents through libudev, which has to see the testbed's own /sys: the program
/// starts itself once more with umockdev's library loaded first.
int main(int argc, char** argv) {
  const char* preload = getenv("LD_PRELOAD");
  if (preload == nullptr || std::strstr(preload, "libumockdev-preload") == nullptr) {
    // In memory: nothing waits for a disk that others use.
    if (access("/dev/shm", R_OK | W_OK | X_OK) == 0) setenv("TMPDIR", "/dev/shm", 1);
    setenv("LD_PRELOAD", "libumockdev-preload.so.0", 1);
    setenv("ASAN_OPTIONS", "verify_asan_link_order=0", 1);
    execv("/proc/self/exe", argv);
    return 1;
  }
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
