#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>

#include "clients/camera/command_line.h"
#include "clients/camera/measure_lens.h"
#include "common/cli/cli.h"
#include "common/runtime/write_file.h"
#include "common/runtime/log.h"

namespace footing::camera {
namespace {

struct LensArguments {
  CommandLine line;
  LensOptions options;
  std::string sheet;
};

/// A sheet of A4 with 13 x 9 dots of 10 mm, 20 mm apart.
std::string Sheet() {
  std::ostringstream svg;
  svg << "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"297mm\" height=\"210mm\" "
         "viewBox=\"0 0 297 210\">\n<rect width=\"297\" height=\"210\" fill=\"white\"/>\n";
  for (int i = 0; i < 13 * 9; ++i)
    svg << "<circle cx=\"" << 28.5 + 20 * (i % 13) << "\" cy=\"" << 25 + 20 * (i / 13)
        << "\" r=\"5\"/>\n";
  svg << "</svg>\n";
  return svg.str();
}

nlohmann::ordered_json ToJson(const LensReport& report) {
  const lens_calibration::LensFit& fit = report.fit;
  const sphere::Lens& lens = fit.lens;
  return {{"fx_px", lens.fx_px},
          {"fy_px", lens.fy_px},
          {"cx_px", lens.cx_px},
          {"cy_px", lens.cy_px},
          {"distortion", {lens.k1, lens.k2, lens.p1, lens.p2, lens.k3}},
          {"residual_rms_px", fit.rms_px},
          {"residual_largest_px", fit.largest_px},
          {"focal_sd_px", fit.focal_sd_px},
          {"centre_sd_px", fit.centre_sd_px},
          {"covered", fit.covered},
          {"views", report.views},
          {"frames", report.frames}};
}

Result<LensReport> MeasureAndStore(LensArguments& arguments) {
  const std::string& path = arguments.line.camera_file;
  if (const auto checked = Check(arguments.line); !checked) return checked.error();
  auto camera = frames::ReadUncalibratedCamera(path);
  if (!camera) return camera.error();
  arguments.options.camera = *camera;
  arguments.options.frames = arguments.line.frames;
  const auto report = MeasureLens(arguments.options);
  if (!report) return report;
  camera->lens = report->fit.lens;
  if (const auto stored = frames::StoreLens(path, *camera); !stored) return stored.error();
  log::Info("stored the lens in " + path);
  return report;
}

int RunLens(LensArguments& arguments) {
  log::Start("footing-camera", arguments.line.quiet);
  if (!arguments.sheet.empty()) {
    const auto written = config::ReplaceFile(arguments.sheet, Sheet());
    if (!written) {
      return cli::Report(
          Failure("cannot write " + arguments.sheet + ": " + written.error().message));
    }
    log::Info("wrote " + arguments.sheet + ": print it and keep it flat");
    if (arguments.line.json) {
      std::cout << nlohmann::ordered_json{{"sheet", arguments.sheet}} << std::endl;
    }
    return 0;
  }
  const auto report = MeasureAndStore(arguments);
  if (!report) return cli::Report(report.error());
  const nlohmann::ordered_json object = ToJson(*report);
  if (arguments.line.json) {
    std::cout << object << std::endl;
    return 0;
  }
  for (const auto& [key, value] : object.items()) std::cout << key << ": " << value << "\n";
  return 0;
}

}  // namespace

void AddLensCommand(CLI::App& app, int& exit_code) {
  auto* command = app.add_subcommand(
      "lens", "Measure focal length, centre and distortion with a printed sheet of dots");
  const auto arguments = std::make_shared<LensArguments>();
  AddCommandLine(*command, arguments->line);
  command->add_option("--sheet", arguments->sheet, "Write the sheet to print, SVG, and end");
  command->add_option("--views", arguments->options.views, "Number of views")
      ->check(CLI::Range(6, 100));
  command->add_option("--seconds", arguments->options.seconds, "Timeout, s")
      ->check(CLI::Range(1.0, 3600.0));
  command->callback([arguments, &exit_code] { exit_code = RunLens(*arguments); });
}

}  // namespace footing::camera
