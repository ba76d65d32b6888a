#pragma once

#include <gtest/gtest.h>
#include <stdlib.h>
#include <unistd.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <functional>
#include <string>

#include "common/transport/address.h"

namespace footing::transport {

/// An io_context, a folder of its own for sockets, and a bounded wait: everything in the test runs
/// on the test's thread.
class IoFixture : public testing::Test {
 protected:
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

  /// Runs handlers until `done` holds; false when it does not within 5 s.
  bool RunUntil(const std::function<bool()>& done) {
    bool late = false;
    boost::asio::steady_timer timer(io_, std::chrono::seconds(5));
    timer.async_wait([&](const boost::system::error_code& error) { late = !error; });
    io_.restart();
    while (!done() && !late) io_.run_one();
    timer.cancel();
    io_.poll();
    return !late;
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
