#include "tests/vm/uhid_node.h"

#include <fcntl.h>
#include <linux/uhid.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace footing::vm {
namespace {

/// For the fixed fields of the kernel's structures, which are zero beforehand.
template <std::size_t size>
void PutText(std::uint8_t (&field)[size], const std::string& text) {
  std::copy_n(text.begin(), std::min(text.size(), size - 1), field);
}

}  // namespace

UhidNode::UhidNode(Handlers handlers)
    : handlers_(std::move(handlers)), file_(open("/dev/uhid", O_RDWR | O_CLOEXEC)) {
  if (file_ >= 0) return;
  std::fprintf(stderr, "error: /dev/uhid: %s; modprobe uhid, as root\n", std::strerror(errno));
  std::exit(1);
}

UhidNode::~UhidNode() { close(file_); }

void UhidNode::Write(const void* event, std::size_t bytes) {
  if (write(file_, event, bytes) >= 0) return;
  std::fprintf(stderr, "error: writing to /dev/uhid: %s\n", std::strerror(errno));
  std::exit(1);
}

void UhidNode::Plug(const virtual_devices::Identity& identity,
                    std::span<const std::uint8_t> descriptor) {
  uhid_event event{};
  event.type = UHID_CREATE2;
  uhid_create2_req& request = event.u.create2;
  PutText(request.name, identity.name);
  PutText(request.uniq, identity.serial);
  request.bus = static_cast<std::uint16_t>(identity.bus);
  request.vendor = identity.vendor;
  request.product = identity.product;
  request.rd_size = static_cast<std::uint16_t>(descriptor.size());
  std::copy(descriptor.begin(), descriptor.end(), request.rd_data);
  Write(&event, sizeof(event));
}

void UhidNode::Unplug() {
  uhid_event event{};
  event.type = UHID_DESTROY;
  Write(&event, sizeof(event));
}

void UhidNode::Send(std::span<const std::uint8_t> report) {
  uhid_event event;
  event.type = UHID_INPUT2;
  event.u.input2.size = static_cast<std::uint16_t>(report.size());
  std::copy(report.begin(), report.end(), event.u.input2.data);
  Write(&event, offsetof(uhid_event, u.input2.data) + report.size());
}

void UhidNode::HandleEvent() {
  uhid_event event{};
  if (read(file_, &event, sizeof(event)) < 0) return;
  if (event.type == UHID_START) {
    handlers_.on_start();
  } else if (event.type == UHID_OUTPUT) {
    handlers_.on_output({event.u.output.data, event.u.output.size});
  } else if (event.type == UHID_SET_REPORT) {
    handlers_.on_output({event.u.set_report.data, event.u.set_report.size});
    uhid_event reply{};
    reply.type = UHID_SET_REPORT_REPLY;
    reply.u.set_report_reply.id = event.u.set_report.id;
    Write(&reply, sizeof(reply));
  } else if (event.type == UHID_GET_REPORT) {
    const auto answer = handlers_.on_feature(event.u.get_report.rnum);
    uhid_event reply{};
    reply.type = UHID_GET_REPORT_REPLY;
    reply.u.get_report_reply.id = event.u.get_report.id;
    reply.u.get_report_reply.err = answer ? 0 : EIO;
    if (answer) {
      reply.u.get_report_reply.size = static_cast<std::uint16_t>(answer->size());
      std::copy(answer->begin(), answer->end(), reply.u.get_report_reply.data);
    }
    Write(&reply, sizeof(reply));
  }
}

}  // namespace footing::vm
