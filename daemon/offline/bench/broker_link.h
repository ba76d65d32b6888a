#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <thread>

#include <sys/types.h>
#include <boost/asio/io_context.hpp>

#include "common/net/address.h"
#include "common/net/socket.h"
#include "common/runtime/exchange.h"

namespace footing::bench {

/// Message brokers that the bench compares with.
enum class BrokerKind { kMosquitto, kNats };

const char* NameOf(BrokerKind kind);

/// Debian's mosquitto or nats-server as a process of this program's own, on a free port of
/// loopback, with nothing on the disk but its config. It ends with this object.
class Broker {
 public:
  /// Null, with a line on standard error, where it is not installed or does not start.
  static std::unique_ptr<Broker> Start(BrokerKind kind);
  ~Broker();
  Broker(const Broker&) = delete;
  Broker& operator=(const Broker&) = delete;

  BrokerKind kind() const { return kind_; }
  const transport::Address& address() const { return address_; }
  /// CPU time of all its threads, from /proc/PID/stat: in steps of 10 ms.
  double CpuSeconds() const;

 private:
  explicit Broker(BrokerKind kind) : kind_(kind) {}
  bool Spawn(const std::string& program);

  BrokerKind kind_;
  transport::Address address_;
  std::string config_;
  pid_t process_ = -1;
};

/// A client of a broker at its barest: one topic, QoS 0, no acknowledgements. It answers nothing,
/// so that it lasts for a minute or two.
class BrokerLink {
 public:
  enum class Part { kPublishes, kSubscribes };

  /// Dials at once. `number` makes its name.
  BrokerLink(boost::asio::io_context& io, const Broker& broker, Part part, int number,
             std::function<void(std::string_view payload)> on_payload);
  ~BrokerLink();
  BrokerLink(const BrokerLink&) = delete;
  BrokerLink& operator=(const BrokerLink&) = delete;

  /// The broker has taken it in, with its subscription.
  bool ready() const;
  void Publish(std::string_view payload);

 private:
  class Implementation;
  std::shared_ptr<Implementation> implementation_;
};

/// Another publisher to compare with: an outlet and an inlet of liblsl in this process, with one
/// string a sample. The library is opened while this program runs, since Debian does not have it.
class LslLink {
 public:
  /// Null, with a line on standard error, if liblsl is not installed or its inlet does not find the
  /// outlet. `on_payload` runs on a thread of the inlet.
  static std::unique_ptr<LslLink> Start(std::function<void(std::string_view payload)> on_payload);
  ~LslLink();
  LslLink(const LslLink&) = delete;
  LslLink& operator=(const LslLink&) = delete;

  /// On any one thread.
  void Publish(std::string_view payload);

 private:
  struct Library;

  LslLink(std::unique_ptr<Library> library,
          std::function<void(std::string_view payload)> on_payload);
  bool Connect();
  void PullOnThread();

  std::unique_ptr<Library> library_;
  std::function<void(std::string_view payload)> on_payload_;
  void* outlet_ = nullptr;
  void* inlet_ = nullptr;
  exchange::Flag stop_;
  std::thread thread_;
};

}  // namespace footing::bench
