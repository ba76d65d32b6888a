#pragma once

#include <sys/types.h>

#include <cstdint>
#include <memory>
#include <string>

#include "common/net/address.h"

namespace footing::bench {

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

}  // namespace footing::bench
