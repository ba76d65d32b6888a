#include "clients/skeleton/receiver.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <boost/asio/io_context.hpp>

#include "clients/skeleton/sender.h"
#include "common/base/units.h"
#include "common/net/device_link.h"
#include "common/net/limits.h"
#include "common/net/socket.h"
#include "common/runtime/clock.h"
#include "common/runtime/log.h"
#include "common/runtime/service_manager.h"
#include "common/runtime/timer.h"

namespace footing::skeleton {
namespace {

namespace asio = boost::asio;

constexpr auto kFlush = std::chrono::milliseconds(10);
constexpr int kMostAtOnce = 64;  // Packets before the other work of this thread has its turn.
constexpr std::int64_t kQuietNs = 10'000'000'000;  // Between two lines on dropped packets.
constexpr std::size_t kMaxQueuedFrames = 64;       // Queue to footingd.
constexpr int kReceiveBytes = 1 << 20;             // Size of the kernel's buffer.

class Receiver {
 public:
  explicit Receiver(const ReceiverOptions& options)
      : options_(options), tracker_(options.tracker), socket_(io_), flush_(io_) {
    if (!options.to) return;
    link_.emplace(
        io_, device_link::Options{.to = *options.to,
                                  .client_name = "footing-skeleton",
                                  .max_queued_frames = kMaxQueuedFrames,
                                  .on_open = [this] {
                                    log::Info("connected to footingd at " + options_.to->Text());
                                  }});
  }

  Result<Reception> Run() {
    boost::system::error_code error;
    socket_.open(options_.listen.protocol(), error);
    if (!error) socket_.bind(options_.listen, error);
    if (!error) socket_.non_blocking(true, error);
    if (error) {
      return Failure("cannot listen on UDP " + options_.listen.address().to_string() + ":" +
                     std::to_string(options_.listen.port()) + ": " + transport::MessageOf(error) +
                     "; choose another port with --listen");
    }
    socket_.set_option(asio::socket_base::receive_buffer_size(kReceiveBytes), error);
    const auto at = socket_.local_endpoint(error);
    log::Info("listening for skeletons on UDP " + at.address().to_string() + ":" +
              std::to_string(at.port()));
    if (link_) link_->Start();
    began_ns_ = clock::MonotonicNs();
    began_cpu_ns_ = clock::ThreadCpuNs();
    end_.After(options_.seconds, [this] {
      if (link_ && !link_->was_open()) published_ = link_->NeverOpen();
      End();
    });
    ReceiveLater();
    FlushLater();
    io_.run();
    Cost cost;
    cost.seconds = NanosecondsToSeconds(ended_ns_ - began_ns_);
    cost.cpu_s = NanosecondsToSeconds(ended_cpu_ns_ - began_cpu_ns_);
    cost.dropped_packets = dropped_;
    cost.published = published_skeletons_;
    cost.hand_frames = link_ ? link_->sent() : 0;
    cost.dropped_hand_frames = link_ ? link_->dropped() : 0;
    return Reception{ToJson(tracker_, cost), std::move(published_)};
  }

 private:
  void ReceiveLater() {
    socket_.async_wait(asio::socket_base::wait_read,
                       [this](const boost::system::error_code& failed) {
                         if (failed) return;
                         Receive();
                         ReceiveLater();
                       });
  }

  void Receive() {
    for (int i = 0; i < kMostAtOnce; ++i) {
      boost::system::error_code error;
      const std::size_t size = socket_.receive(asio::buffer(bytes_), 0, error);
      if (error) return;  // No packet is waiting.
      TakePacket({bytes_.data(), size});
    }
  }

  void TakePacket(osc::Bytes packet) {
    const std::int64_t now_ns = clock::MonotonicNs();
    if (!Allow(now_ns)) return;
    tracker_.Take(packet, now_ns, clock::WallNs(), observations_);
    Publish(now_ns);
  }

  bool Allow(std::int64_t now_ns) {
    if (bucket_.Spend(now_ns)) return true;
    if (dropped_++ == 0 || now_ns - dropped_line_ns_ > kQuietNs) {
      log::Warning("too many packets: " + std::to_string(dropped_) + " dropped so far");
      dropped_line_ns_ = now_ns;
    }
    return false;
  }

  void FlushLater() {
    flush_.After(kFlush, [this] {
      const std::int64_t now_ns = clock::MonotonicNs();
      tracker_.Flush(now_ns, clock::WallNs(), observations_);
      Publish(now_ns);
      for (const std::string& line : tracker_.Messages()) log::Info(line);
      FlushLater();
    });
  }

  void Publish(std::int64_t now_ns) {
    for (const Observation& observation : observations_) {
      if (!link_) break;
      ++published_skeletons_;
      link_->Send(ToHandFrame(observation, now_ns));
    }
    observations_.clear();
  }

  void End() {
    ended_ns_ = clock::MonotonicNs();
    ended_cpu_ns_ = clock::ThreadCpuNs();
    boost::system::error_code ignored;
    socket_.close(ignored);
    flush_.cancel();
    end_.cancel();
    if (link_) link_->Stop("stopped");
  }

  const ReceiverOptions options_;
  asio::io_context io_{1};
  Tracker tracker_;
  service_manager::ProgramEnd end_{io_, [this] { End(); }};
  asio::ip::udp::socket socket_;
  timer::Timer flush_;
  std::optional<device_link::DeviceLink> link_;
  std::array<std::uint8_t, osc::kMostPacketBytes> bytes_;
  std::vector<Observation> observations_;
  /// A tenth of a second at once.
  transport::TokenBucket bucket_{options_.most_packets_per_s,
                                 std::max(1.0, 0.1 * options_.most_packets_per_s)};
  std::int64_t dropped_line_ns_ = 0;
  std::uint64_t dropped_ = 0, published_skeletons_ = 0;
  Result<void> published_;
  std::int64_t began_ns_ = 0, ended_ns_ = 0, began_cpu_ns_ = 0, ended_cpu_ns_ = 0;
};

}  // namespace

Result<Reception> RunReceiver(const ReceiverOptions& options) {
  return std::make_unique<Receiver>(options)->Run();
}

}  // namespace footing::skeleton
