#pragma once

#include <boost/asio/io_context.hpp>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "common/net/address.h"
#include "common/net/client.h"
#include "footing/v1/session.pb.h"

namespace footing::stream_client {

/// The eyes of a synthetic user, player or person: calls `see` with what the server publishes in
/// these channels. Everything runs on the io_context's one thread.
std::unique_ptr<transport::Client> Watch(boost::asio::io_context& io,
                                         const transport::Address& server,
                                         std::vector<std::string> channels,
                                         std::function<void(const v1::Tick&)> see);

}  // namespace footing::stream_client
