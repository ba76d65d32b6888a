#include "clients/camera/video_port.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>
#include <utility>

#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <nlohmann/json.hpp>

#include "common/camera/fit_lens.h"
#include "common/cli/cli.h"
#include "common/frames/camera_file.h"
#include "common/runtime/clock.h"
#include "common/runtime/files.h"
#include "common/runtime/log.h"
#include "common/runtime/service_manager.h"
#include "common/runtime/timer.h"

namespace footing::camera {

namespace {

std::string Size(int width, int height) {
  return std::to_string(width) + "x" + std::to_string(height);
}

}  // namespace

Result<void> CheckSize(const frames::Frame& frame, const frames::CameraFile& camera) {
  if (frame.width == camera.lens.width && frame.height == camera.lens.height) return {};
  return InvalidData("a frame has " + Size(frame.width, frame.height) +
                     " pixels, but the camera file is for " +
                     Size(camera.lens.width, camera.lens.height) +
                     "; set the camera to that size, or measure its lens again (footing-camera "
                     "lens)");
}

Result<std::unique_ptr<Source>> OpenFrames(boost::asio::io_context& io, const FrameOptions& options,
                                           const frames::CameraFile& camera,
                                           std::function<void(const std::string&)> alarm) {
  if (!options.folder.empty()) return OpenFolder(io, options.folder, camera, options.repeats);
  if (!options.pipe.empty()) return OpenPipe(io, options.pipe, options.pipe_settings);
  return OpenVideo(io, options.device, camera, options.video, std::move(alarm));
}

namespace {

class FolderSource : public Source {
 public:
  FolderSource(boost::asio::io_context& io, std::vector<std::string> files,
               const frames::CameraFile& camera, bool repeats)
      : timer_(io), files_(std::move(files)), camera_(camera), repeats_(repeats) {}

  void Start(OnFrame on_frame, OnEnd on_end) override {
    on_frame_ = std::move(on_frame);
    on_end_ = std::move(on_end);
    due_ = timer::Now();
    Wait();
  }

  void Stop() override { timer_.cancel(); }

 private:
  void Wait() {
    timer_.At(due_, [this] { Deliver(); });
  }

  void Deliver() {
    if (next_ == files_.size()) {
      if (!repeats_) return on_end_({});
      next_ = 0;
    }
    const auto frame = frames::ReadFrame(files_[next_++], camera_.lens.width, camera_.lens.height);
    if (!frame) return on_end_(frame.error());
    const std::int64_t exposed_ns = clock::MonotonicNs();
    // At the camera's rate; what could not be had in time is not made up for. Before the frame is
    // handed on, which may end in Stop().
    due_ = std::max(due_ + std::chrono::nanoseconds(std::llround(1e9 / camera_.rate_hz)),
                    timer::Now());
    Wait();
    on_frame_(*frame, exposed_ns);
  }

  timer::Timer timer_;
  const std::vector<std::string> files_;
  const frames::CameraFile camera_;
  const bool repeats_;
  OnFrame on_frame_;
  OnEnd on_end_;
  std::size_t next_ = 0;
  std::chrono::steady_clock::time_point due_;
};

}  // namespace

Result<std::unique_ptr<Source>> OpenFolder(boost::asio::io_context& io, const std::string& folder,
                                           const frames::CameraFile& camera, bool repeats) {
  auto files = frames::FramesOf(folder);
  if (!files) return files.error();
  return std::unique_ptr<Source>(
      std::make_unique<FolderSource>(io, *std::move(files), camera, repeats));
}

namespace {

class PipeSource : public Source {
 public:
  PipeSource(boost::asio::io_context& io, int descriptor, const PipeSettings& settings)
      : pipe_(io, descriptor),
        latency_ns_(static_cast<std::int64_t>(1e9 * settings.latency_s)),
        stamped_(settings.stamped) {}

  void Start(OnFrame on_frame, OnEnd on_end) override {
    on_frame_ = std::move(on_frame);
    on_end_ = std::move(on_end);
    Read();
  }

  void Stop() override {
    boost::system::error_code ignored;
    pipe_.close(ignored);
  }

 private:
  void Read() {
    pipe_.async_read_some(boost::asio::buffer(buffer_),
                          [this](boost::system::error_code error, std::size_t count) {
                            if (error == boost::asio::error::operation_aborted) return;
                            if (error == boost::asio::error::eof) return AtEnd();
                            if (error) return on_end_(Failure("frames: " + error.message()));
                            Take(count);
                          });
  }

  void AtEnd() {
    if (reader_.empty()) return on_end_({});
    on_end_(InvalidData("frames: the last image is cut off"));
  }

  void Take(std::size_t count) {
    reader_.Add({buffer_.data(), count});
    const std::int64_t exposed_ns = clock::MonotonicNs() - latency_ns_;
    while (true) {
      const auto frame = reader_.Next();
      if (!frame) return on_end_(frame.error());
      if (!*frame) break;
      const auto& time_ns = (*frame)->time_ns;
      if (stamped_ && !time_ns)
        return on_end_(InvalidData("frames: an image has no comment with its time (# time_ns N)"));
      on_frame_(**frame, stamped_ ? *time_ns : exposed_ns);
    }
    if (pipe_.is_open()) Read();
  }

  boost::asio::posix::stream_descriptor pipe_;
  const std::int64_t latency_ns_;
  const bool stamped_;
  OnFrame on_frame_;
  OnEnd on_end_;
  frames::NetpbmReader reader_;
  std::array<char, 1 << 16> buffer_;
};

}  // namespace

Result<std::unique_ptr<Source>> OpenPipe(boost::asio::io_context& io, const std::string& path,
                                         const PipeSettings& settings) {
  // Blocks until a writer opens the FIFO; without a writer, a read would return end of file at
  // once.
  const int descriptor = path == "-" ? ::dup(STDIN_FILENO) : ::open(path.c_str(), O_RDONLY);
  if (descriptor < 0)
    return Failure("cannot open " + path + ": " + std::string(std::strerror(errno)));
  try {
    return std::unique_ptr<Source>(std::make_unique<PipeSource>(io, descriptor, settings));
  } catch (const boost::system::system_error& error) {
    ::close(descriptor);
    return Failure(path + " is not a FIFO: " + error.code().message() +
                   "; frames of a folder come with --frames");
  }
}

namespace {

constexpr std::uint32_t kBuffers = 4;
constexpr std::uint64_t kFramesBetweenChecks = 120;  // Interval of control checks, a few seconds.

class KernelPort : public VideoPort {
 public:
  explicit KernelPort(int descriptor) : descriptor_(descriptor) {}
  int Control(unsigned long request, void* argument) override {
    while (::ioctl(descriptor_, request, argument) != 0) {
      if (errno != EINTR) return errno;
    }
    return 0;
  }

 private:
  int descriptor_;
};

v4l2_buffer BufferOf(std::uint32_t index) {
  v4l2_buffer buffer{};
  buffer.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  buffer.memory = V4L2_MEMORY_MMAP;
  buffer.index = index;
  return buffer;
}

class VideoSource : public Source {
 public:
  VideoSource(boost::asio::io_context& io, int descriptor, const frames::CameraFile& camera,
              const VideoSettings& settings, std::function<void(const std::string&)> alarm)
      : device_(io, descriptor),
        port_(descriptor),
        camera_(camera),
        settings_(settings),
        alarm_(std::move(alarm)) {}

  ~VideoSource() override {
    for (const Mapped& one : mapped_) ::munmap(one.start, one.size);
  }

  Result<void> Open() {
    if (const auto agreed = Negotiate(port_, camera_); !agreed) return agreed;
    for (const std::string& line : LockControls(port_, settings_)) alarm_(line);
    controls_.emplace(port_, settings_);
    return Map();
  }

  void Start(OnFrame on_frame, OnEnd on_end) override {
    on_frame_ = std::move(on_frame);
    on_end_ = std::move(on_end);
    int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    if (const int error = port_.Control(VIDIOC_STREAMON, &type); error != 0)
      return on_end_(Failure("camera: it does not start: " + std::string(std::strerror(error))));
    Wait();
  }

  void Stop() override {
    int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    port_.Control(VIDIOC_STREAMOFF, &type);
    boost::system::error_code ignored;
    device_.cancel(ignored);
  }

 private:
  struct Mapped {
    void* start;
    std::size_t size;
  };

  Result<void> Map() {
    v4l2_requestbuffers request{};
    request.count = kBuffers;
    request.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    request.memory = V4L2_MEMORY_MMAP;
    if (const int error = port_.Control(VIDIOC_REQBUFS, &request); error != 0)
      return Failure("camera: no buffers: " + std::string(std::strerror(error)));
    for (std::uint32_t i = 0; i < request.count; ++i) {
      v4l2_buffer buffer = BufferOf(i);
      if (const int error = port_.Control(VIDIOC_QUERYBUF, &buffer); error != 0)
        return Failure("camera: no buffer: " + std::string(std::strerror(error)));
      void* start = ::mmap(nullptr, buffer.length, PROT_READ | PROT_WRITE, MAP_SHARED,
                           device_.native_handle(), buffer.m.offset);
      if (start == MAP_FAILED)
        return Failure("camera: a buffer cannot be mapped: " + std::string(std::strerror(errno)));
      mapped_.push_back({start, buffer.length});
      port_.Control(VIDIOC_QBUF, &buffer);
    }
    return {};
  }

  void Wait() {
    device_.async_wait(boost::asio::posix::stream_descriptor::wait_read,
                       [this](boost::system::error_code error) {
                         if (!error) Take();
                       });
  }

  /// The newest waiting frame; older ones only cost time.
  void Take() {
    v4l2_buffer newest{};
    bool has_one = false;
    while (true) {
      v4l2_buffer buffer = BufferOf(0);
      const int error = port_.Control(VIDIOC_DQBUF, &buffer);
      if (error == EAGAIN) break;
      if (error != 0)
        return on_end_(Failure("camera: it is gone: " + std::string(std::strerror(error))));
      if (has_one) port_.Control(VIDIOC_QBUF, &newest);
      newest = buffer;
      has_one = true;
    }
    if (has_one) Deliver(newest);
    if (++frames_ % kFramesBetweenChecks == 0)
      for (const std::string& line : controls_->Check()) alarm_(line);
    Wait();
  }

  void Deliver(v4l2_buffer& buffer) {
    const int width = camera_.lens.width, height = camera_.lens.height;
    const auto size = static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
                      static_cast<std::size_t>(sphere::BytesPerPixel(camera_.format));
    const Mapped& mapped = mapped_[buffer.index % mapped_.size()];
    const bool is_whole = buffer.bytesused >= size && mapped.size >= size &&
                          (buffer.flags & V4L2_BUF_FLAG_ERROR) == 0;
    if (is_whole) {
      const auto* bytes = static_cast<const std::uint8_t*>(mapped.start);
      const frames::Frame frame{camera_.format, width, height, {bytes, bytes + size}, {}};
      on_frame_(frame, ExposedNs(buffer, camera_, settings_.exposure_s, clock::MonotonicNs()));
    }
    port_.Control(VIDIOC_QBUF, &buffer);
  }

  boost::asio::posix::stream_descriptor device_;
  KernelPort port_;
  const frames::CameraFile camera_;
  const VideoSettings settings_;
  const std::function<void(const std::string&)> alarm_;
  std::optional<LockedControls> controls_;
  std::uint64_t frames_ = 0;
  std::vector<Mapped> mapped_;
  OnFrame on_frame_;
  OnEnd on_end_;
};

}  // namespace

Result<std::unique_ptr<Source>> OpenVideo(boost::asio::io_context& io, const std::string& device,
                                          const frames::CameraFile& camera,
                                          const VideoSettings& settings,
                                          std::function<void(const std::string&)> alarm) {
  const int descriptor = ::open(device.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) {
    return NoDevice("cannot open " + device + ": " + std::strerror(errno) +
                    "; is the camera plugged in, and are you in the group video?");
  }
  auto probe = v4l2_capability{};
  if (KernelPort(descriptor).Control(VIDIOC_QUERYCAP, &probe) != 0) {
    ::close(descriptor);
    return NoDevice(device + " is not a camera");
  }
  auto source = std::make_unique<VideoSource>(io, descriptor, camera, settings, std::move(alarm));
  if (const auto opened = source->Open(); !opened) return opened.error();
  return std::unique_ptr<Source>(std::move(source));
}

namespace {

std::string FourLetters(std::uint32_t format) {
  std::string letters;
  for (int i = 0; i < 4; ++i) letters += static_cast<char>((format >> (8 * i)) & 0x7f);
  return letters;
}

/// Nothing when the camera does not have the control.
std::optional<std::int32_t> Get(VideoPort& port, std::uint32_t id) {
  v4l2_control control{id, -1};
  if (port.Control(VIDIOC_G_CTRL, &control) != 0) return std::nullopt;
  return control.value;
}

/// One control: set, and read back. Nothing when the camera does not have it.
std::optional<std::int32_t> Set(VideoPort& port, std::uint32_t id, std::int32_t value) {
  v4l2_control control{id, value};
  if (port.Control(VIDIOC_S_CTRL, &control) != 0) return std::nullopt;
  return Get(port, id);
}

struct Lock {
  std::uint32_t id;
  std::int32_t value;
  const char* name;
  const char* harm;
};

constexpr char kBrightness[] =
    "the sphere's light changes by itself, and with it where its edge is";
constexpr char kHue[] = "the sphere's hue changes by itself, and it may be lost";

std::vector<Lock> LocksOf(const VideoSettings& settings) {
  std::vector<Lock> locks = {
      {V4L2_CID_EXPOSURE_AUTO, V4L2_EXPOSURE_MANUAL, "automatic exposure", kBrightness},
      {V4L2_CID_AUTOGAIN, 0, "automatic gain", kBrightness},
      {V4L2_CID_AUTO_WHITE_BALANCE, 0, "automatic white balance", kHue},
      // In units of 100 microseconds.
      {V4L2_CID_EXPOSURE_ABSOLUTE,
       static_cast<std::int32_t>(std::lround(1e4 * settings.exposure_s)), "exposure time",
       kBrightness}};
  if (settings.gain >= 0) locks.push_back({V4L2_CID_GAIN, settings.gain, "gain", kBrightness});
  return locks;
}

}  // namespace

Result<void> Negotiate(VideoPort& port, const frames::CameraFile& camera) {
  const bool is_yuyv = camera.format == sphere::PixelFormat::kYuyv;
  v4l2_format format{};
  format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  format.fmt.pix.width = static_cast<std::uint32_t>(camera.lens.width);
  format.fmt.pix.height = static_cast<std::uint32_t>(camera.lens.height);
  format.fmt.pix.pixelformat = is_yuyv ? V4L2_PIX_FMT_YUYV : V4L2_PIX_FMT_SGRBG8;
  format.fmt.pix.field = V4L2_FIELD_NONE;
  const v4l2_pix_format wanted = format.fmt.pix;
  if (const int error = port.Control(VIDIOC_S_FMT, &format); error != 0)
    return Failure("camera: its format cannot be set: " + std::string(std::strerror(error)));
  const v4l2_pix_format& given = format.fmt.pix;
  const std::uint32_t row = wanted.width * (is_yuyv ? 2 : 1);
  if (given.pixelformat != wanted.pixelformat || given.width != wanted.width ||
      given.height != wanted.height || (given.bytesperline != 0 && given.bytesperline != row)) {
    return InvalidData("camera: it gives " + FourLetters(given.pixelformat) + " " +
                       std::to_string(given.width) + "x" + std::to_string(given.height) + ", not " +
                       FourLetters(wanted.pixelformat) + " " + std::to_string(wanted.width) + "x" +
                       std::to_string(wanted.height) +
                       "; change format, width or height of the camera file");
  }
  v4l2_streamparm rate{};
  rate.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  rate.parm.capture.timeperframe = {1000, static_cast<std::uint32_t>(1000 * camera.rate_hz)};
  port.Control(VIDIOC_S_PARM, &rate);  // Many drivers have one rate only; a frame has its own time.
  return {};
}

std::vector<std::string> LockControls(VideoPort& port, const VideoSettings& settings) {
  std::vector<std::string> alarms;
  for (const Lock& lock : LocksOf(settings)) {
    const auto read = Set(port, lock.id, lock.value);
    const std::string wanted = std::to_string(lock.value);
    if (!read) {
      alarms.push_back(std::string("camera: ") + lock.name + " cannot be set to " + wanted + ": " +
                       lock.harm);
    } else if (*read != lock.value) {
      alarms.push_back(std::string("camera: ") + lock.name + " is " + std::to_string(*read) +
                       " in spite of " + wanted + ": " + lock.harm);
    }
  }
  return alarms;
}

LockedControls::LockedControls(VideoPort& port, const VideoSettings& settings) : port_(port) {
  for (const Lock& lock : LocksOf(settings))
    if (Get(port, lock.id) == lock.value)
      watched_.push_back({lock.id, lock.value, lock.name, lock.harm, true});
}

std::vector<std::string> LockedControls::Check() {
  std::vector<std::string> lines;
  for (Watched& one : watched_) {
    const auto now = Get(port_, one.id);
    const bool held = std::exchange(one.holds, now == one.value);
    if (one.holds) continue;
    one.holds = Set(port_, one.id, one.value) == one.value;
    // One that cannot be set again is named once.
    if (!held) continue;
    const std::string what =
        "camera: " + one.name + " has changed to " + (now ? std::to_string(*now) : "nothing");
    lines.push_back(one.holds ? what + " and was set to " + std::to_string(one.value) + " again"
                              : what + " and cannot be set again: " + one.harm);
  }
  return lines;
}

std::int64_t ExposedNs(const v4l2_buffer& buffer, const frames::CameraFile& camera,
                       double exposure_s, std::int64_t now_ns) {
  const double half_s = 0.5 * (camera.readout_s + exposure_s);
  const auto half_ns = static_cast<std::int64_t>(std::llround(1e9 * half_s));
  if ((buffer.flags & V4L2_BUF_FLAG_TIMESTAMP_MASK) != V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC)
    return now_ns - half_ns;
  const std::int64_t stamp_ns = static_cast<std::int64_t>(buffer.timestamp.tv_sec) * 1'000'000'000 +
                                static_cast<std::int64_t>(buffer.timestamp.tv_usec) * 1000;
  const bool at_start =
      (buffer.flags & V4L2_BUF_FLAG_TSTAMP_SRC_MASK) == V4L2_BUF_FLAG_TSTAMP_SRC_SOE;
  return at_start ? stamp_ns + half_ns : stamp_ns - half_ns;
}

void AddCommandLine(CLI::App& app, CommandLine& line) {
  FrameOptions& frames = line.frames;
  app.add_option("--camera", line.camera_file, "Camera file, JSON (docs/camera.md)");
  app.add_option("--device", frames.device, "Camera, such as /dev/video0");
  app.add_option("--frames", frames.folder, "Folder of frames: .pgm, .ppm or .yuyv files");
  app.add_option("--fifo", frames.pipe,
                 "FIFO of PGM or PPM images, one after the other; - for standard input");
  app.add_option("--exposure-s", frames.video.exposure_s, "Exposure time of a camera, s")
      ->check(CLI::Range(0.0001, 1.0));
  app.add_option("--gain", frames.video.gain,
                 "Gain of a camera, on its own scale (-1: leave unchanged)")
      ->check(CLI::Range(-1, 100000));
  app.add_option("--latency-s", frames.pipe_settings.latency_s,
                 "Time from the exposure of a FIFO's frame to its last byte, s")
      ->check(CLI::Range(0.0, 1.0));
  app.add_flag(
      "--stamped", frames.pipe_settings.stamped,
      "Take a FIFO frame's exposure from its comment # time_ns, of the host's monotonic clock");
  app.add_flag("--repeat", frames.repeats, "Play the frames of a folder again and again");
  app.add_flag("--json", line.json, "One JSON object on standard output, at the end");
  app.add_flag("-q,--quiet", line.quiet, "Log only warnings and errors");
}

Result<void> Check(const CommandLine& line) {
  if (line.camera_file.empty()) return UsageError("--camera FILE is missing (docs/camera.md)");
  const FrameOptions& frames = line.frames;
  if (frames.device.empty() + frames.folder.empty() + frames.pipe.empty() != 2)
    return UsageError("name one of --device, --frames and --fifo");
  return {};
}

void ApplyExposure(const CommandLine& line, frames::CameraFile& camera) {
  if (!line.frames.device.empty())
    camera.settings.shutter.exposure_s = line.frames.video.exposure_s;
}

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

namespace {

class LensMeasurement {
 public:
  explicit LensMeasurement(const LensOptions& options)
      : options_(options),
        program_end_(io_, [this] { End(Failure("stopped")); }),
        collector_(options.views, options.frames.folder.empty()) {}

  Result<LensReport> Run() {
    auto source = OpenFrames(io_, options_.frames, options_.camera,
                             [](const std::string& line) { log::Warning(line); });
    if (!source) return source.error();
    source_ = std::move(source).value();
    program_end_.After(options_.seconds, [this] { End({}); });
    source_->Start([this](const frames::Frame& frame, std::int64_t) { Take(frame); },
                   [this](Result<void> end) { End(std::move(end)); });
    io_.run();
    if (!end_) return end_.error();
    const sphere::Lens& lens = options_.camera.lens;
    const auto fit = lens_calibration::FitLens(collector_.views(), lens.width, lens.height);
    if (!fit) return fit.error();
    return LensReport{*fit, frames_, collector_.views().size()};
  }

 private:
  void Take(const frames::Frame& frame) {
    if (ended_) return;
    if (const auto checked = CheckSize(frame, options_.camera); !checked)
      return End(checked.error());
    ++frames_;
    collector_.Take(frame.View());
    if (collector_.is_complete()) return End({});
    if (const std::string advice = collector_.Advice(); advice != advice_) {
      log::Info(advice);
      advice_ = advice;
    }
  }

  void End(Result<void> end) {
    if (std::exchange(ended_, true)) return;
    end_ = std::move(end);
    source_->Stop();
    program_end_.cancel();
  }

  const LensOptions& options_;
  boost::asio::io_context io_{1};
  service_manager::ProgramEnd program_end_;
  std::unique_ptr<Source> source_;
  lens_calibration::ViewCollector collector_;
  std::size_t frames_ = 0;
  std::string advice_;
  Result<void> end_;
  bool ended_ = false;
};

}  // namespace

Result<LensReport> MeasureLens(const LensOptions& options) {
  return LensMeasurement(options).Run();
}

}  // namespace footing::camera
