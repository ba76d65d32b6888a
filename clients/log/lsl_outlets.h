#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include <boost/asio/io_context.hpp>

#include "clients/log/lsl.h"
#include "common/base/result.h"

namespace footing::log_client::lsl {

/// Where streams are offered.
struct OutletsOptions {
  std::string interface = "127.0.0.1";  ///< IPv4 address of this host.
  bool insecure_lan = false;            ///< The address may be one of a network.
};

/// Counts of one stream.
struct OutletReport {
  std::string name;
  std::string type;
  std::size_t channels = 0;
  std::uint64_t samples = 0;
  std::uint64_t feeds = 0;    ///< Readers so far.
  std::uint64_t dropped = 0;  ///< Those of them that did not read.
};

/// Streams of LSL for any number of readers: found by queries over UDP, each with a TCP port of its
/// own, with one time service for all. On loopback only queries of this host are answered.
/// Everything runs on the io_context's one thread, and nothing waits for a reader: one that leaves
/// a MiB unread is dropped. Reads and requests are bounded in bytes, number and time.
class Outlets {
 public:
  static constexpr std::size_t kMostStreams = 128;
  static constexpr std::size_t kMostConnections = 256;
  static constexpr std::size_t kMostWaitingBytes = 1u << 20;

  /// A network's address without the option, or one that this host does not have, is a usage error.
  static Result<std::unique_ptr<Outlets>> Open(boost::asio::io_context& io,
                                               const OutletsOptions& options);
  ~Outlets();
  Outlets(const Outlets&) = delete;
  Outlets& operator=(const Outlets&) = delete;

  /// Offers a stream of doubles or of one text; its uid, host, ports and start are filled in.
  /// Returns its number, from 0.
  Result<std::size_t> Add(Info info);
  /// Gives every reader of a stream a sample. `values` has as many numbers as it has channels.
  void Push(std::size_t stream, double time_s, std::span<const double> values);
  void Push(std::size_t stream, double time_s, std::string_view text);

  std::size_t size() const;
  const Info& info(std::size_t stream) const;
  OutletReport report(std::size_t stream) const;

 private:
  class Implementation;
  explicit Outlets(std::shared_ptr<Implementation> implementation);
  std::shared_ptr<Implementation> implementation_;
};

/// Time now, s of CLOCK_MONOTONIC: local_clock() of liblsl.
double NowS();

/// A new random uid, UUID version 4.
std::string NewUid();

}  // namespace footing::log_client::lsl
