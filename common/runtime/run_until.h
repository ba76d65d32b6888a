#pragma once

#include <boost/asio/io_context.hpp>
#include <functional>

namespace footing::timer {

/// How a wait ended.
enum class Waited { kDone, kTimeUp, kInterrupted };

/// Handles events of the io_context until the condition holds, which is asked after each of them;
/// without one until the time is up. `interrupted` is asked first.
Waited RunUntil(boost::asio::io_context& io, const std::function<bool()>& condition,
                double within_s, const std::function<bool()>& interrupted);

}  // namespace footing::timer
