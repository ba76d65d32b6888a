#pragma once

#include <cstdint>
#include <string>

#include "common/base/result.h"
#include "common/net/client.h"
#include "footing/v1/session.pb.h"

/// What a client says to its server, as functions of what it knows.
namespace footing::transport {

/// Over TCP with the token of the environment where the options have none; an error when its file
/// cannot be used. Beyond this host a token goes over tcp:, where everybody on the way can read it,
/// only with FOOTING_INSECURE_LAN=1; an error otherwise.
Result<v1::Envelope> MakeHello(const ClientOptions& options);

/// Asks for the ticks behind `last_sequence` of `last_epoch`, or, when that is 0, for those that
/// the options say. `epoch` is that of the server that welcomed us.
v1::Envelope MakeSubscribe(const ClientOptions& options, std::uint64_t epoch,
                           std::uint64_t last_epoch, std::uint64_t last_sequence);

v1::Envelope MakeRefill(std::uint64_t from_sequence, std::uint64_t to_sequence);
v1::Envelope MakePing(std::uint64_t id, std::int64_t now_ns);
v1::Envelope MakePong(const v1::Ping& ping, std::int64_t arrived_ns, std::int64_t now_ns);

/// What a client that finds nobody says: the dial's error, and the reason that the server gave when
/// it ended the last connection, if it did.
std::string WaitingText(const std::string& dial_error, const std::string& last_reason);

}  // namespace footing::transport
