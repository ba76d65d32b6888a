#include <hidapi/hidapi.h>

#include <thread>
#include <vector>

/// Reads the nodes given as arguments, a thread and a hid_read loop each, and does nothing with
/// what it reads: the least that reading with hidapi costs. Ends when they do.
int main(int argc, char** argv) {
  std::vector<std::thread> threads;
  for (int i = 1; i < argc; ++i) {
    hid_device* const device = hid_open_path(argv[i]);
    if (device == nullptr) return 1;
    threads.emplace_back([device] {
      unsigned char report[64];
      while (hid_read(device, report, sizeof(report)) >= 0) {
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  return 0;
}
