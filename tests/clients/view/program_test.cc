#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

// The program itself, run as a user runs it; no server is there.
namespace footing::view {
namespace {

using ::testing::HasSubstr;

struct Outcome {
  int code = -1;
  std::string output;
};

/// Runs a command line; `output` holds standard output.
Outcome RunCommand(const std::string& command) {
  Outcome outcome;
  FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return outcome;
  std::array<char, 4096> buffer{};
  for (std::size_t got; (got = fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) {
    outcome.output.append(buffer.data(), got);
  }
  const int status = pclose(pipe);
  if (WIFEXITED(status)) outcome.code = WEXITSTATUS(status);
  return outcome;
}

class ProgramTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("view_test." + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string View(const std::string& words) const {
    // Mesa's leaks are not ours: see picture_test.cc.
    return "ASAN_OPTIONS=detect_leaks=0 " + std::string(FOOTING_BINARY_DIR) +
           "/bin/footing-view --connect unix:" + (folder_ / "simulation.sock").string() + " " +
           words;
  }
  std::string File(const char* name) const { return (folder_ / name).string(); }

  std::filesystem::path folder_;
};

TEST_F(ProgramTest, WithoutAServerTheTextSaysWhatItWaitsForAndHowToStartIt) {
  const Outcome outcome = RunCommand("env -u DISPLAY " + View("--seconds 0.2") + " 2>&1");
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.output, HasSubstr("error: no server: "));
  EXPECT_THAT(outcome.output, HasSubstr("simulation.sock: no such file; start footing-sim"));
  EXPECT_THAT(outcome.output, HasSubstr("no display"));
  EXPECT_THAT(outcome.output, HasSubstr("Waiting for a simulation server on unix:"));
  EXPECT_THAT(outcome.output, HasSubstr("footing-sim"));
}

TEST_F(ProgramTest, AViewerThatWasNeverLetInFails) {
  // The viewer reads its token file once it is connected, before it sends anything.
  const int server = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  auto* const generic = reinterpret_cast<sockaddr*>(&address);
  ASSERT_EQ(bind(server, generic, size), 0);
  ASSERT_EQ(listen(server, 1), 0);
  ASSERT_EQ(getsockname(server, generic, &size), 0);
  const Outcome outcome =
      RunCommand("ASAN_OPTIONS=detect_leaks=0 FOOTING_TOKEN_FILE=" + File("none") + " " +
                 std::string(FOOTING_BINARY_DIR) +
                 "/bin/footing-view --text --seconds 0.5 --connect tcp:127.0.0.1:" +
                 std::to_string(ntohs(address.sin_port)) + " 2>&1");
  close(server);
  EXPECT_EQ(outcome.code, 1) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("No connection to the server"));
  EXPECT_THAT(outcome.output, HasSubstr("error: FOOTING_TOKEN_FILE: token file"));
}

TEST_F(ProgramTest, WithJsonStandardOutputIsOneObject) {
  const Outcome outcome = RunCommand(View("--text --seconds 0.2 --json") + " 2>/dev/null");
  EXPECT_EQ(outcome.code, 3);  // There is nothing to sum up, and yet it is an object.
  const auto summary = nlohmann::json::parse(outcome.output);
  EXPECT_EQ(summary.at("frames_received"), 0);
  EXPECT_GE(summary.at("frames_drawn"), 1);
  EXPECT_EQ(summary.at("gaits_seen").size(), 0u);
  EXPECT_EQ(summary.at("falls"), 0);
  EXPECT_TRUE(summary.contains("publish_to_view_p50_ms"));
  EXPECT_TRUE(summary.contains("publish_to_view_p99_ms"));
  EXPECT_TRUE(summary.contains("distance_m"));
}

TEST_F(ProgramTest, AScreenshotNeedsNoDisplayAndNoServer) {
  const std::string png = File("waiting.png");
  const Outcome outcome =
      RunCommand("env -u DISPLAY " +
                 View("--screenshot " + png + " --at 0.1 --width 320 --height 180") + " 2>&1");
  EXPECT_EQ(outcome.code, 0) << outcome.output;
  EXPECT_GT(std::filesystem::file_size(png), 1000u);
  EXPECT_THAT(outcome.output, HasSubstr("no server has sent anything yet"));
}

TEST_F(ProgramTest, ARecordingIsNumberedPictures) {
  const std::string to = File("frames");
  const Outcome outcome = RunCommand(
      View("--record " + to + " --seconds 0.5 --record-hz 4 --width 320 --height 180") + " 2>&1");
  EXPECT_EQ(outcome.code, 0) << outcome.output;
  EXPECT_TRUE(std::filesystem::exists(to + "/000000.png"));
  EXPECT_TRUE(std::filesystem::exists(to + "/000001.png"));
  EXPECT_FALSE(std::filesystem::exists(to + "/000002.png"));
}

TEST_F(ProgramTest, ARecordingDoesNotOverwriteAnother) {
  const std::string to = File("kept");
  std::filesystem::create_directories(to);
  { std::ofstream(to + "/000007.png") << "kept"; }
  const Outcome outcome =
      RunCommand(View("--record " + to + " --seconds 0.2 --width 320 --height 180") + " 2>&1");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.output, HasSubstr("has pictures already (000007.png)"));
  EXPECT_THAT(outcome.output, HasSubstr("name another folder"));
  EXPECT_EQ(std::filesystem::file_size(to + "/000007.png"), 4u);
}

TEST_F(ProgramTest, WithoutAnEncoderAFilmIsAFolderOfPictures) {
  const std::string film = File("walk.mp4"), folder = File("walk");
  const std::string words = "--record " + film + " --seconds 0.5 --width 320 --height 180";
  const Outcome without = RunCommand("PATH=/nowhere " + View(words) + " 2>&1");
  EXPECT_EQ(without.code, 0) << without.output;
  EXPECT_THAT(without.output, HasSubstr("no ffmpeg or GStreamer"));
  EXPECT_THAT(without.output, HasSubstr("apt install ffmpeg"));
  EXPECT_THAT(without.output, HasSubstr("wrote 5 pictures to " + folder));
  EXPECT_FALSE(std::filesystem::exists(film));
  EXPECT_TRUE(std::filesystem::exists(folder + "/000004.png"));
  const Outcome again = RunCommand("PATH=/nowhere " + View(words) + " 2>&1");
  EXPECT_EQ(again.code, 2);
  EXPECT_THAT(again.output, HasSubstr("has pictures already"));
}

TEST_F(ProgramTest, AFilmIsMadeByTheEncoderAndOverwritesNone) {
  const std::string film = File("walk.mp4");
  const std::string words = "--record " + film + " --seconds 0.5 --width 320 --height 180";
  // An encoder that takes raw pictures on its standard input and names the film last.
  const std::string folder = File("encoder");
  std::filesystem::create_directories(folder);
  { std::ofstream(folder + "/ffmpeg") << "#!/bin/sh\nfor to; do :; done\nexec cat >\"$to\"\n"; }
  std::filesystem::permissions(folder + "/ffmpeg", std::filesystem::perms::owner_all);
  const Outcome with = RunCommand("PATH=" + folder + ":/usr/bin:/bin " + View(words) + " 2>&1");
  EXPECT_EQ(with.code, 0) << with.output;
  EXPECT_EQ(std::filesystem::file_size(film), 5u * 320 * 180 * 3);
  const Outcome again = RunCommand("PATH=" + folder + ":/usr/bin:/bin " + View(words) + " 2>&1");
  EXPECT_EQ(again.code, 2);
  EXPECT_THAT(again.output, HasSubstr("there is such a file already"));
}

TEST_F(ProgramTest, InstalledEncodersMakeFilmsThatBeginAsTheirFormatsDo) {
  const bool ffmpeg = std::system("command -v ffmpeg >/dev/null 2>&1") == 0;
  const bool gstreamer =
      std::system(
          "gst-inspect-1.0 --exists x264enc && gst-inspect-1.0 --exists mp4mux && "
          "command -v gst-launch-1.0 >/dev/null") == 0;
  if (!ffmpeg && !gstreamer) {
    GTEST_SKIP() << "no encoder is installed (apt install ffmpeg)";
  }
  // Only the programs of one encoder are on the PATH. An odd size is padded.
  const auto film_by = [this](const std::string& name, const std::string& programs) {
    const std::string folder = File(name.c_str()), film = folder + "/walk.mp4";
    std::filesystem::create_directories(folder);
    const Outcome done =
        RunCommand("for one in " + programs + "; do ln -s $(command -v $one) " + folder +
                   "/; done; PATH=" + folder + " " +
                   View("--record " + film + " --seconds 0.5 --width 321 --height 181") + " 2>&1");
    EXPECT_EQ(done.code, 0) << done.output;
    std::ifstream file(film, std::ios::binary);
    std::array<char, 8> head{};
    file.read(head.data(), head.size());
    // ISO 14496-12, 4.3: a size of 32 bits, then the type of the first box.
    EXPECT_EQ(std::string(head.data() + 4, 4), "ftyp") << name << ": " << done.output;
    EXPECT_GT(std::filesystem::file_size(film), 1000u);
  };
  if (ffmpeg) film_by("by_ffmpeg", "ffmpeg");
  if (gstreamer) film_by("by_gstreamer", "gst-inspect-1.0 gst-launch-1.0");
}

TEST_F(ProgramTest, AScreenshotIsWhatItsNameSays) {
  const std::string size = " --at 0 --width 320 --height 180";
  const std::string jpg = File("a.jpg");
  EXPECT_EQ(RunCommand(View("--screenshot " + jpg + size) + " 2>&1").code, 0);
  std::ifstream file(jpg, std::ios::binary);
  EXPECT_EQ(file.get(), 0xff);
  EXPECT_EQ(file.get(), 0xd8);
  const Outcome refused = RunCommand(View("--screenshot a.bmp" + size) + " 2>&1");
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.output, HasSubstr("PNG or JPEG"));
  EXPECT_THAT(refused.output, HasSubstr("a.png"));
}

TEST_F(ProgramTest, WrongWordsEndWithTwoAndOneLine) {
  for (const char* words : {"--recording walk.mcap", "--connect nonsense", "--msaa 3", "--at x",
                            "--ui-scale 9", "--panels clock"}) {
    const Outcome outcome = RunCommand(View(words) + " 2>&1");
    EXPECT_EQ(outcome.code, 2) << words << ": " << outcome.output;
    EXPECT_FALSE(outcome.output.empty());
  }
}

TEST_F(ProgramTest, APictureThatCannotBeWrittenEndsWithOneAndNamesTheFile) {
  const Outcome outcome =
      RunCommand(View("--screenshot /nowhere/a.png --at 0 --width 320 --height 180") + " 2>&1");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.output, HasSubstr("/nowhere/a.png"));
}

/// Runs the viewer in a window; Xvfb picks a free display and writes its number, and ends when its
/// only client leaves.
std::string InWindow(const std::string& number_file, const std::string& view) {
  return "sh -c 'exec 3>" + number_file + "; Xvfb -displayfd 3 -screen 0 " +
         "800x600x24 -nolisten tcp 2>/dev/null & server=$!; " + "for i in $(seq 100); do [ -s " +
         number_file + " ] && break; sleep 0.1; done; DISPLAY=:$(cat " + number_file + ") " + view +
         " 2>&1; code=$?; kill $server; exit $code'";
}

bool HasXvfb() { return std::system("command -v Xvfb >/dev/null 2>&1") == 0; }

TEST_F(ProgramTest, TheWindowOpensOnADisplayAndDraws) {
  if (!HasXvfb())
    GTEST_SKIP() << "Xvfb is not installed: the window is not tried (apt install xvfb)";
  const Outcome outcome =
      RunCommand(InWindow(File("number"), View("--seconds 1.5 --json --width 640 --height 360")));
  EXPECT_EQ(outcome.code, 0) << outcome.output;
  const auto summary = nlohmann::json::parse(outcome.output);
  // llvmpipe on a busy machine; a window that hangs draws one picture or none.
  EXPECT_GE(summary.at("frames_drawn"), 5);
}

TEST_F(ProgramTest, WithoutASoundCardTheWindowSaysSoAndGoesOn) {
  if (!HasXvfb())
    GTEST_SKIP() << "Xvfb is not installed: the window is not tried (apt install xvfb)";
  // OpenAL's device without output is all that it may use.
  const Outcome outcome = RunCommand(
      InWindow(File("number"),
               "ALSOFT_DRIVERS=null " + View("--sound --seconds 1 --width 320 --height 180")));
  EXPECT_EQ(outcome.code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("no sound: "));
}

}  // namespace
}  // namespace footing::view
