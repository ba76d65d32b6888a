#include "tests/device_faults/node.h"

#include <fcntl.h>
#include <linux/hidraw.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "tests/device_faults/report_descriptor.h"

namespace footing::device_faults {
namespace {

using boost::asio::posix::stream_descriptor;
using Wait = boost::asio::posix::descriptor_base;

std::runtime_error Broken(const std::string& what) {
  return std::runtime_error("bench: " + what + ": " + std::strerror(errno));
}

}  // namespace

Node::Node(boost::asio::io_context& io, std::string folder, int number, std::string name,
           Handlers handlers)
    : io_(io),
      folder_(std::move(folder)),
      base_("hidraw" + std::to_string(number)),
      name_(std::move(name)),
      handlers_(std::move(handlers)),
      listener_(io),
      control_(io) {
  const std::string path = folder_ + "/" + base_ + ".page";
  unlink(path.c_str());  // Who still has the old one sees it gone.
  const int file = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  if (file < 0 || ftruncate(file, sizeof(NodePage)) != 0) throw Broken(path);
  void* memory = mmap(nullptr, sizeof(NodePage), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  close(file);
  if (memory == MAP_FAILED) throw Broken(path);
  page_ = static_cast<NodePage*>(memory);
  listener_ = Listen("");
  control_ = Listen(".control");
  AcceptOpening();
  AcceptControl();
}

Node::~Node() {
  HangUp();
  munmap(page_, sizeof(NodePage));
}

stream_descriptor Node::Listen(const std::string& suffix) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string path = folder_ + "/" + base_ + suffix;
  path.copy(address.sun_path, sizeof(address.sun_path) - 1);
  unlink(path.c_str());
  const int descriptor = socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (descriptor < 0 ||
      bind(descriptor, reinterpret_cast<sockaddr*>(&address), sizeof(address)) != 0 ||
      listen(descriptor, 16) != 0) {
    throw Broken(path);
  }
  return stream_descriptor(io_, descriptor);
}

void Node::AcceptOpening() {
  listener_.async_wait(
      Wait::wait_read, [this, alive = std::weak_ptr<int>(alive_)](boost::system::error_code error) {
        if (error || alive.expired()) return;
        const int descriptor =
            accept4(listener_.native_handle(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
        if (descriptor >= 0) {
          // Room for far more than 64 reports: the queue's bound is counted, not the kernel's.
          const int bytes = 1 << 20;
          setsockopt(descriptor, SOL_SOCKET, SO_SNDBUF, &bytes, sizeof(bytes));
          openings_.emplace_back(stream_descriptor(io_, descriptor));
          Read(std::prev(openings_.end()));
        }
        AcceptOpening();
      });
}

void Node::Read(std::list<Opening>::iterator opening) {
  opening->socket.async_wait(Wait::wait_read, [this, opening, alive = std::weak_ptr<int>(alive_)](
                                                  boost::system::error_code error) {
    if (error || alive.expired() || page_->gone.load() != 0) return;
    std::uint8_t bytes[512];
    const ssize_t size = recv(opening->socket.native_handle(), bytes, sizeof(bytes), 0);
    if (size < 0 && (errno == EAGAIN || errno == EINTR)) return Read(opening);
    if (size <= 0) {
      openings_.erase(opening);
      return;
    }
    if (!opening->index) {
      std::uint32_t index = 0;
      std::memcpy(&index, bytes, sizeof(index));
      opening->index = index;
    } else {
      handlers_.on_output({bytes, static_cast<std::size_t>(size)});
      if (alive.expired() || page_->gone.load() != 0) return;  // It unplugged itself.
    }
    Read(opening);
  });
}

void Node::AcceptControl() {
  control_.async_wait(
      Wait::wait_read, [this, alive = std::weak_ptr<int>(alive_)](boost::system::error_code error) {
        if (error || alive.expired()) return;
        const int descriptor = accept4(control_.native_handle(), nullptr, nullptr, SOCK_CLOEXEC);
        if (descriptor >= 0) {
          AnswerControl(descriptor);  // The shim has sent its packet, or is about to.
          close(descriptor);
        }
        AcceptControl();
      });
}

void Node::AnswerControl(int descriptor) {
  std::uint8_t in[8192] = {};
  const ssize_t size = recv(descriptor, in, sizeof(in), 0);
  if (size < 4) return;
  std::uint32_t request = 0;
  std::memcpy(&request, in, 4);
  std::int32_t result = 0;
  Bytes out(4);
  const auto append = [&out](const void* bytes, std::size_t count) {
    const auto* from = static_cast<const std::uint8_t*>(bytes);
    out.insert(out.end(), from, from + count);
  };
  const std::uint32_t descriptor_bytes = sizeof(kReportDescriptor);
  const std::uint32_t number = request & 0xff;
  if (request == HIDIOCGRDESCSIZE) {
    append(&descriptor_bytes, sizeof(descriptor_bytes));
  } else if (request == HIDIOCGRDESC) {
    append(&descriptor_bytes, sizeof(descriptor_bytes));
    append(kReportDescriptor, descriptor_bytes);
  } else if (number == 0x04) {  // HIDIOCGRAWNAME
    append(name_.c_str(), name_.size() + 1);
    result = static_cast<std::int32_t>(name_.size() + 1);
  } else if (number == 0x07) {  // HIDIOCGFEATURE
    const auto answer = handlers_.on_feature
                            ? handlers_.on_feature(in[4], static_cast<std::size_t>(size) - 4)
                            : std::nullopt;
    if (answer) {
      append(answer->data(), answer->size());
      result = static_cast<std::int32_t>(answer->size());
    } else {
      result = -EIO;
    }
  } else {
    result = -EINVAL;
  }
  std::memcpy(out.data(), &result, 4);
  send(descriptor, out.data(), out.size(), MSG_NOSIGNAL);
}

void Node::Send(std::span<const std::uint8_t> report) {
  if (page_->gone.load() != 0) return;
  Bytes packet(1);
  packet.insert(packet.end(), report.begin(), report.end());
  for (Opening& opening : openings_) {
    if (!opening.index) continue;
    const std::uint32_t waiting = opening.sent - page_->reads[*opening.index].load();
    if (waiting >= kHidrawQueueReports || send(opening.socket.native_handle(), packet.data(),
                                               packet.size(), MSG_NOSIGNAL | MSG_DONTWAIT) < 0) {
      ++dropped_;
    } else {
      ++opening.sent;
    }
  }
}

void Node::HangUp() {
  if (page_->gone.exchange(1) != 0) return;
  for (const char* suffix : {"", ".control", ".page"}) {
    unlink((folder_ + "/" + base_ + suffix).c_str());
  }
  for (Opening& opening : openings_) shutdown(opening.socket.native_handle(), SHUT_RDWR);
  openings_.clear();
  boost::system::error_code ignored;
  listener_.close(ignored);
  control_.close(ignored);
}

}  // namespace footing::device_faults
