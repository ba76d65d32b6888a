#pragma once

#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/virtual/devices/accelerometer.h"

namespace footing::stream_client {

/// A built-in file: its name and its text.
struct SampleFile {
  std::string name;
  std::string text;
};

/// Small input files for every program, computed from the synthetic person: accelerations
/// (left.csv, right.csv, 100 Hz), the corners of a board under a standing person (corners.csv),
/// subjects (p07.json, p08.json, p09.json), a motion clip (clip.bvh) and its activities
/// (labels.csv), a table for the trainers (sway.csv), and tables of a study for footing-eval stats:
/// fifteen subjects with four interfaces (ratings.csv, oscillation.csv, failures.csv), and a
/// simulated camera (camera.json). The same on every call.
Result<std::vector<SampleFile>> SampleFiles();

/// Writes them into a folder, which it creates. A file of the same name and other content is
/// somebody's own: with `replace` it is replaced, else it is an error and nothing is written.
Result<void> WriteSampleFiles(const std::string& folder, bool replace);

/// Names of the built-in scripts.
std::vector<std::string> ScriptNames();

/// The built-in script of that name; a usage error that lists the names when there is none.
Result<std::vector<wrists::Segment>> ScriptNamed(const std::string& name);

/// A script from JSON: a list of objects {duration_s, frequency_hz, phase_deg, amplitude_mps2,
/// roll_deg, pitch_deg}, all but duration_s optional. `origin` names it in errors, which say which
/// stretch and what its values may be.
Result<std::vector<wrists::Segment>> ParseScript(const std::string& text,
                                                 const std::string& origin);

}  // namespace footing::stream_client
