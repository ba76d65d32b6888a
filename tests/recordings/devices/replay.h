#pragma once

#include <string>

#include "daemon/sensor/service/device.h"
#include "tests/recordings/devices/capture.h"

namespace footing::recordings {

/// Runs what the device sent through a Hub whose clock is the capture's, a tick every 10 ms, and
/// gives what was published: samples of all kinds, and the last status before the end. What
/// footingd sends is not answered: the capture already holds the answers.
Result<sensor::TickContent> Replay(const Capture& capture);

/// A line a sample in SI with fixed decimals, in the order of their kinds; the status first. Times
/// are milliseconds since the attachment, of arrival. Left out is what hangs on filters and clock
/// fits, which have tests of their own (filtered values, time of sampling).
std::string Print(const sensor::TickContent& content);

}  // namespace footing::recordings
