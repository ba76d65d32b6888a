#pragma once

#include <boost/asio/io_context.hpp>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "common/base/result.h"
#include "common/net/address.h"
#include "common/stream/hands.h"
#include "footing/v1/device.pb.h"

/// A client's side of footingd's device socket, or, beyond this host, of a session that attaches
/// devices (docs/protocol.md).
namespace footing::device_link {

/// Address of footingd, and the calls that a link makes.
struct Options {
  transport::Address to;
  std::string client_name = {};          ///< Name of the session, for people.
  std::size_t max_queued_frames = 1024;  ///< Messages that wait while footingd does not read.
  std::function<void()> on_open = {};    ///< After each connection is made.
  std::function<void(const v1::DeviceEnvelope& message)> on_message = {};
  /// After each refusal, which the log has: of the device in its slot, or of the whole connection,
  /// which then ends.
  std::function<void(const v1::DeviceRefused& message)> on_refused = {};
  std::function<void()> on_close = {};  ///< After each connection is lost; not after Stop().
};

/// One connection to the device socket, dialled again four times a second while there is none; the
/// log says why, once for each reason. Where BySession() holds it is a session with the role
/// control, by the rules of all clients (transport::Client). Everything runs on the io_context's
/// one thread.
class DeviceLink {
 public:
  DeviceLink(boost::asio::io_context& io, Options options);
  ~DeviceLink();
  DeviceLink(const DeviceLink&) = delete;
  DeviceLink& operator=(const DeviceLink&) = delete;

  void Start();

  /// False when the message is dropped: there is no connection, or its queue is full. Hands and
  /// reports of the past are of no use later.
  bool Send(const v1::DeviceEnvelope& message);
  bool Send(const stream::HandFrame& frame);

  /// Sends what is queued and closes; does not dial again.
  void Stop(const std::string& reason);

  bool open() const;
  bool was_open() const;  ///< Whether footingd has let it in at any time.
  /// The error of a program that has waited for footingd as long as it was to run, in vain.
  Error NeverOpen() const;
  std::uint64_t sent() const;
  std::uint64_t dropped() const;

 private:
  class Implementation;
  std::shared_ptr<Implementation> implementation_;
};

/// Whether devices go to this address within a session: to tls:, and to tcp: beyond this host.
bool BySession(const transport::Address& to);

/// Help of the option that names the address.
inline constexpr char kToHelp[] =
    "Address of footingd's device socket, unix:PATH or tcp:HOST:PORT; tls:HOST:PORT on another "
    "host, with its token in the file that FOOTING_TOKEN_FILE names";

}  // namespace footing::device_link
