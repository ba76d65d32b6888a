#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tests/device_faults/node_page.h"

namespace footing::device_faults {

/// The device's side of one /dev/hidrawN, for every program that runs with the shim: reports in and
/// out with hidraw's queue, ioctls, and faults. Everything runs on the io_context's one thread.
class Node {
 public:
  using Bytes = std::vector<std::uint8_t>;

  struct Handlers {
    std::function<void(std::span<const std::uint8_t>)> on_output;
    std::function<std::optional<Bytes>(std::uint8_t id, std::size_t size)> on_feature;
  };

  Node(boost::asio::io_context& io, std::string folder, int number, std::string name,
       Handlers handlers);
  ~Node();
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;

  /// Queues one report for every reader; drops it where 64 wait, as hidraw does.
  void Send(std::span<const std::uint8_t> report);
  /// Hangs up: reads end with EIO, writes with ENODEV, opening too.
  void HangUp();

  NodePage& page() { return *page_; }
  std::uint64_t dropped() const { return dropped_; }
  std::size_t openings() const { return openings_.size(); }

 private:
  struct Opening {
    explicit Opening(boost::asio::posix::stream_descriptor opened) : socket(std::move(opened)) {}
    boost::asio::posix::stream_descriptor socket;
    std::optional<std::uint32_t> index;
    std::uint32_t sent = 0;
  };

  boost::asio::posix::stream_descriptor Listen(const std::string& suffix);
  void AcceptOpening();
  void AcceptControl();
  void Read(std::list<Opening>::iterator opening);
  void AnswerControl(int descriptor);

  boost::asio::io_context& io_;
  std::string folder_;
  std::string base_;  ///< "hidraw3"
  std::string name_;
  Handlers handlers_;
  NodePage* page_ = nullptr;
  boost::asio::posix::stream_descriptor listener_;
  boost::asio::posix::stream_descriptor control_;
  std::list<Opening> openings_;
  std::uint64_t dropped_ = 0;
  std::shared_ptr<int> alive_ = std::make_shared<int>();
};

}  // namespace footing::device_faults
