#pragma once

#include <vector>

#include "common/stream/sensor.h"
#include "daemon/sensor/reports/input_report.h"

/// The bright points that a Wiimote's infrared camera sees.
namespace footing::reports {

/// At most four, only those seen. The format is known by the size (WiiBrew, "Wiimote/IR camera"):
/// 10 bytes basic (no sizes), 12 extended, 18 half of full (points 1 and 2, or 3 and 4), 36 full;
/// any other size gives none. A point that is not seen is all FF; one whose row or column is
/// outside the camera's 1024 x 768 is not seen either.
std::vector<stream::CameraPoint> DecodeCamera(Bytes camera);

}  // namespace footing::reports
