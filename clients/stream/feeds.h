#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>

#include "clients/stream/body_stage.h"
#include "clients/stream/plan.h"
#include "common/body/points.h"

namespace footing::stream_client {

/// Both fists 60 times a second as a tracker with white noise sees them.
Feed HandFeed(std::shared_ptr<const Stage> stage, double noise_m, std::uint64_t seed);

/// Both fists and all joints as a Kinect's skeleton tracker measures them
/// (virtual_sensors::KinectSkeleton); what the body hides from it is inferred and said to be
/// hidden.
Feed KinectFeed(std::shared_ptr<const Stage> stage, std::uint64_t seed);

/// The sphere of a cap as a tracker with white noise that shows nothing else of a skeleton sees it.
Feed HeadFeed(std::shared_ptr<const Stage> stage, double noise_m, std::uint64_t seed);

/// The true pose 60 times a second: all joints, or of a skeleton of more than 64 those on the way
/// to a landmark.
Feed PoseFeed(std::shared_ptr<const Stage> stage);

/// The middle of the fist of side 0 (left) or 1, in W.
Eigen::Vector3d FistAt(const Stage& stage, int side, double t_s);

/// A point of the body, in W.
Eigen::Vector3d PlaceAt(const Stage& stage, const body::Point& point, double t_s);

/// The sphere of a cap, 12 cm above the middle of the head.
body::Point CapSphere(const Stage& stage);

/// Ends a plan of what is under the feet: the fists where `hands` is "move" or "kinect", the true
/// pose, and how long it takes.
void AddBodyFeeds(const std::shared_ptr<const Stage>& stage, const std::string& hands,
                  double hand_noise_m, const Common& common, Plan& plan);

/// Joints of a skeleton that fit into a reference frame, parents first.
std::vector<int> ShownJoints(const body::Body& body);

}  // namespace footing::stream_client
