#pragma once

#include "daemon/simulation/momentum/horizontal_com.h"

/// The horizontal filters expect a body in place. Where a body steps, lunges or pushes off, they
/// lag behind by more than they report, and filters of a travelling body, which also see where
/// hands and feet have C, are better.
namespace footing::momentum {

/// The prior of a body that travels, for the axis of this prior of a body in place.
HorizontalPrior Travelling(HorizontalPrior in_place);
/// How the pose from hands and feet alone is wrong about C of such a body.
PostureError TravellingPosture();

/// Variance (m²) of C beyond what the filter of a body in place reports: by how much the last COPs
/// surprised it, and how far a body that has just stepped is from it (`stepped_m`, else 0).
double DoubtOf(const HorizontalCom& in_place, double stepped_m);

/// C by the filter of a body in place, moved towards that of a travelling body as far as the doubt
/// in the former goes. Without doubt it is the former.
HorizontalCom::Filter::Scalar Weigh(const HorizontalCom::Filter::Scalar& in_place, double doubt_m2,
                                    const HorizontalCom::Filter::Scalar& travelling);

}  // namespace footing::momentum
