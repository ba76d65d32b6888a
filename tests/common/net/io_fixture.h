#pragma once

#include <gtest/gtest.h>
#include <stdlib.h>
#include <unistd.h>

#include <boost/asio/io_context.hpp>
#include <functional>
#include <string>

#include "common/net/address.h"
#include "common/runtime/timer.h"

namespace footing::transport {

/// An io_context, a folder of its own for sockets, and a bounded wait: everything in the test runs
/// on the test's thread.
class IoFixture : public testing::Test {
 protected:
  static constexpr double kWithinS = 60;  // No load of the machine explains more.

  IoFixture() {
    std::string name = "/tmp/footing-test-XXXXXX";
    folder_ = mkdtemp(name.data());
  }
  ~IoFixture() override {
    rmdir(folder_.c_str());  // Fails, and shows, when a socket file is left.
  }

  Address UnixAddress(const std::string& name = "s") const {
    Address address;
    address.path = folder_ + "/" + name;
    return address;
  }
  static Address TcpAddress() {
    Address address;
    address.kind = Address::Kind::kTcp;
    address.host = "127.0.0.1";
    return address;
  }

  /// Runs handlers until `done` holds; false when it does not within kWithinS.
  bool RunUntil(const std::function<bool()>& done) {
    io_.restart();
    const auto never = [] { return false; };
    const bool held = timer::RunUntil(io_, done, kWithinS, never) == timer::Waited::kDone;
    io_.poll();
    return held;
  }

  /// Runs handlers until nothing is ready.
  void Settle() {
    io_.restart();
    while (io_.poll() > 0) {
    }
  }

  std::string folder_;
  boost::asio::io_context io_;
};

}  // namespace footing::transport
