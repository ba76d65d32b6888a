#include "daemon/sensor/kinds/kind.h"

#include "daemon/sensor/kinds/inertial.h"
#include "daemon/sensor/kinds/joycon.h"
#include "daemon/sensor/kinds/ps_move.h"
#include "daemon/sensor/kinds/wiimote_protocol.h"

namespace footing::kinds {

std::unique_ptr<Kind> MakeKind(const decode::KindOptions& options, const decode::Product& product,
                               const Stored& stored) {
  if (ps_move::PsMove::Matches(product)) {
    return std::make_unique<ps_move::PsMove>(product, stored);
  }
  if (inertial::InertialSensor::Matches(product)) {
    return std::make_unique<inertial::InertialSensor>();
  }
  if (joycon::Joycon::Matches(product)) return std::make_unique<joycon::Joycon>(product);
  return std::make_unique<WiimoteProtocol>(options, product);
}

}  // namespace footing::kinds
