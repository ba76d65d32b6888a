#pragma once

#include <cstdint>

#include "clients/view/render/hud_layout.h"
#include "clients/view/render/paint.h"
#include "clients/view/scene/model.h"
#include "clients/view/scene/stage.h"

namespace footing::render {

/// Heights that the body's panel asks for.
PanelHeight BodyPanelHeight(const scene::CharacterPose& pose, const scene::Picture& picture);

/// Subject, mode, lag, T-pose, resets, feet and hands of a reconstructed body; keys, angular
/// momentum and the legend of the reference only where there is space for them.
void DrawBodyPanel(const Paint& paint, const Box& box, const scene::CharacterPose& pose,
                   const scene::Picture& picture);

/// Heights that the character's panel asks for; `phases`: with the states of the gait controller,
/// only where there is space for them.
PanelHeight CharacterPanelHeight(bool phases);

/// Gait, speed against command, turn, pending command, distance, falls, and the strip of the gait
/// controller's states.
void DrawCharacterPanel(const Paint& paint, const Box& box, const scene::Model& model,
                        const scene::CharacterPose& pose, std::int64_t now_ns);

/// Draws the calibration's panel at the bottom of `space`: the present instruction, the progress of
/// the rest on the mark, and in the end the result or the refusal.
void DrawCalibrationPanel(const Paint& paint, const scene::Calibration& calibration,
                          const Box& space);

/// The T-pose wizard at the bottom of `space`: what to do, and a ring that fills in five seconds.
/// Once the pose is taken, only what is wrong.
void DrawTPosePanel(const Paint& paint, const scene::Model& model, const scene::CharacterPose& pose,
                    const Box& space);

}  // namespace footing::render
