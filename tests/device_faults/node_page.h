#pragma once

#include <atomic>
#include <cstdint>

namespace footing::device_faults {

/// State that the bench and the shim share of one /dev/hidrawN: a page in a file of the bench's
/// folder. The shim runs in the program under test, so it holds plain lock-free numbers only.
struct NodePage {
  static constexpr std::uint32_t kMaxOpens = 256;

  std::atomic<std::int32_t> open_errno;   ///< While not 0 open() fails with it.
  std::atomic<std::int32_t> write_errno;  ///< While write_faults > 0 write() fails with it.
  std::atomic<std::int32_t> write_faults;
  std::atomic<std::int32_t> write_blocks;  ///< While not 0 write() does not return.
  std::atomic<std::int32_t> read_errno;    ///< While read_faults > 0 a report read becomes it.
  std::atomic<std::int32_t> read_faults;
  std::atomic<std::int32_t> gone;    ///< Unplugged: reads give EIO, writes ENODEV.
  std::atomic<std::uint32_t> opens;  ///< How often it was opened; the index of the newest.
  std::atomic<std::uint32_t> reads[kMaxOpens];  ///< Reports read by each opening: hidraw's queue.
  std::atomic<std::int64_t> written_ns[kMaxOpens];  ///< The newest write began.
  std::atomic<std::int64_t> closest_writes_ns;      ///< Shortest time between two of one opening.
  /// CPU time of the thread that reads the opening, as of its last report of a count of 32: the
  /// clock is a system call, which would be part of what it measures.
  std::atomic<std::int64_t> cpu_ns[kMaxOpens];
  std::atomic<std::uint32_t> cpu_reads[kMaxOpens];  ///< The count then.
};

/// hidraw's own: HIDRAW_BUFFER_SIZE. When it is full the newest report is dropped.
inline constexpr std::uint32_t kHidrawQueueReports = 64;
inline constexpr std::uint32_t kCpuEveryReports = 32;

}  // namespace footing::device_faults
