#pragma once

#include <boost/asio/io_context.hpp>
#include <functional>
#include <string>
#include <string_view>

namespace footing::fuzz {

/// From now on the calling thread's clock and timers have simulated time, which goes on only while
/// it waits. May be called again.
void FollowSimulatedTime();

/// Runs the loop until nothing is left to do at this instant and `seconds` have passed, or until
/// `done` holds.
void RunFor(
    boost::asio::io_context& io, double seconds,
    const std::function<bool()>& done = [] { return false; });

/// Simulated time that one input may take: it costs a message to the timekeeper for each instant at
/// which something is sent.
class TimeBudget {
 public:
  /// As many of the seconds as are left.
  double Take(double seconds) {
    const double taken = seconds < left_s_ ? seconds : left_s_;
    left_s_ -= taken;
    return taken;
  }

 private:
  double left_s_ = 30;
};

/// The other end of a stream socket, as a hostile peer sees it. Owns the descriptor; never blocks.
class RawPeer {
 public:
  explicit RawPeer(int descriptor = -1) : descriptor_(descriptor) {}
  ~RawPeer() { Close(); }
  RawPeer(const RawPeer&) = delete;
  RawPeer& operator=(const RawPeer&) = delete;

  bool open() const { return descriptor_ >= 0; }
  void Take(int descriptor);
  /// Writes as many of the bytes as the socket takes.
  void Write(std::string_view bytes);
  /// Everything that is there.
  std::string Read();
  /// Says that nothing more will be written.
  void EndWriting();
  void Close();

 private:
  int descriptor_;
};

}  // namespace footing::fuzz
