#pragma once

#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "common/net/address.h"

namespace footing::relay {

/// As much of a NATS server as one client needs, within the test: it delivers what the test says,
/// and hands over what the client publishes.
class NatsServer {
 public:
  using OnPublished = std::function<void(const std::string& subject, const std::string& reply,
                                         const std::string& payload)>;

  NatsServer(boost::asio::io_context& io, OnPublished on_published)
      : acceptor_(io, {boost::asio::ip::address_v4::loopback(), 0}),
        on_published_(std::move(on_published)) {
    Accept();
  }

  transport::Address address() const {
    transport::Address address;
    address.kind = transport::Address::Kind::kTcp;
    address.host = "127.0.0.1";
    address.port = acceptor_.local_endpoint().port();
    return address;
  }

  bool IsSubscribed(const std::string& subject) const { return subscriptions_.count(subject) > 0; }

  /// Nothing happens when the client has not subscribed to it.
  void Deliver(const std::string& subject, const std::string& payload) {
    const auto found = subscriptions_.find(subject);
    if (found == subscriptions_.end()) return;
    Write("MSG " + subject + " " + found->second + " " + std::to_string(payload.size()) + "\r\n" +
          payload + "\r\n");
  }

  /// Ends the client's connection; it may come again.
  void Break() {
    subscriptions_.clear();
    socket_.reset();
  }

 private:
  void Accept() {
    acceptor_.async_accept(
        [this](const boost::system::error_code& error, boost::asio::ip::tcp::socket socket) {
          if (error) return;
          socket_.emplace(std::move(socket));
          socket_->set_option(boost::asio::ip::tcp::no_delay(true));  // No time passes in between.
          received_.clear();
          Write("INFO {\"max_payload\":1048576}\r\n");
          Read();
          Accept();
        });
  }

  void Read() {
    socket_->async_read_some(boost::asio::buffer(bytes_),
                             [this](const boost::system::error_code& error, std::size_t count) {
                               if (error || !socket_) return;
                               received_.append(bytes_.data(), count);
                               while (socket_ && TakeOne()) {
                               }
                               if (socket_) Read();
                             });
  }

  /// Handles one complete message of the client; false when there is none.
  bool TakeOne() {
    const std::size_t end = received_.find("\r\n");
    if (end == std::string::npos) return false;
    const std::string line = received_.substr(0, end);
    if (line.rfind("PUB ", 0) == 0) return TakePublished(line, end + 2);
    received_.erase(0, end + 2);
    if (line == "PING") Write("PONG\r\n");
    if (line.rfind("SUB ", 0) == 0) {
      const std::size_t space = line.rfind(' ');
      subscriptions_[line.substr(4, space - 4)] = line.substr(space + 1);
    }
    return true;
  }

  bool TakePublished(const std::string& line, std::size_t begin) {
    const std::size_t first = line.find(' ', 4), last = line.rfind(' ');
    const std::size_t size = std::stoul(line.substr(last + 1));
    if (received_.size() < begin + size + 2) return false;
    const std::string payload = received_.substr(begin, size);
    received_.erase(0, begin + size + 2);
    const std::string reply = first < last ? line.substr(first + 1, last - first - 1) : "";
    on_published_(line.substr(4, first - 4), reply, payload);
    return true;
  }

  void Write(const std::string& bytes) {
    boost::system::error_code gone;  // The client may be; its own side says so.
    if (socket_) boost::asio::write(*socket_, boost::asio::buffer(bytes), gone);
  }

  boost::asio::ip::tcp::acceptor acceptor_;
  OnPublished on_published_;
  std::optional<boost::asio::ip::tcp::socket> socket_;
  std::array<char, 16 << 10> bytes_;
  std::string received_;
  std::map<std::string, std::string> subscriptions_;  ///< Number by subject.
};

}  // namespace footing::relay
