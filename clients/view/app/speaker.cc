#include "clients/view/app/speaker.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

#include "common/runtime/log.h"

#ifdef FOOTING_OPENAL
#include <AL/al.h>
#include <AL/alc.h>
#endif

namespace footing::view {

#ifdef FOOTING_OPENAL

namespace {

constexpr int kSampleRateHz = 44100;
constexpr std::size_t kPlayers = 16;

/// OpenAL plays into a device without output if it finds nothing else.
bool IsSilent(ALCdevice* device) {
  const ALCchar* name = alcGetString(device, ALC_ALL_DEVICES_SPECIFIER);
  return name == nullptr || std::string(name) == "No Output";
}

}  // namespace

struct Speaker::Device {
  struct Player {
    ALuint source = 0, buffer = 0;
  };

  explicit Device(ALCdevice* opened) : device(opened), context(alcCreateContext(opened, nullptr)) {
    alcMakeContextCurrent(context);
    for (Player& player : players) {
      alGenSources(1, &player.source);
      alGenBuffers(1, &player.buffer);
      // Beside the listener, whatever the world: the picture has said where.
      alSourcei(player.source, AL_SOURCE_RELATIVE, AL_TRUE);
    }
  }
  ~Device() {
    for (Player& player : players) {
      alDeleteSources(1, &player.source);
      alDeleteBuffers(1, &player.buffer);
    }
    alcMakeContextCurrent(nullptr);
    alcDestroyContext(context);
    alcCloseDevice(device);
  }
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  void Play(const scene::Sound& sound) {
    Player& player = players[next];
    next = (next + 1) % kPlayers;
    std::vector<std::int16_t> samples;
    for (const float sample : scene::Synthesized(sound, kSampleRateHz))
      samples.push_back(static_cast<std::int16_t>(std::lround(32767 * sample)));
    alSourceStop(player.source);
    alSourcei(player.source, AL_BUFFER, 0);
    alBufferData(player.buffer, AL_FORMAT_MONO16, samples.data(),
                 static_cast<ALsizei>(samples.size() * sizeof(std::int16_t)), kSampleRateHz);
    alSourcei(player.source, AL_BUFFER, static_cast<ALint>(player.buffer));
    const auto right = static_cast<float>(sound.pan);
    alSource3f(player.source, AL_POSITION, right, 0, -std::sqrt(std::max(0.0f, 1 - right * right)));
    alSourcePlay(player.source);
  }

  ALCdevice* device;
  ALCcontext* context;
  std::array<Player, kPlayers> players;
  std::size_t next = 0;
};

Result<Speaker> Speaker::Open() {
  ALCdevice* const device = alcOpenDevice(nullptr);
  if (device == nullptr || IsSilent(device)) {
    if (device != nullptr) alcCloseDevice(device);
    return NoDevice("no sound: this machine has no sound device that answers");
  }
  return Speaker(std::make_unique<Device>(device));
}

void Speaker::Play(const std::vector<scene::Sound>& sounds) {
  for (const scene::Sound& sound : sounds) device_->Play(sound);
}

#else

struct Speaker::Device {};

Result<Speaker> Speaker::Open() {
  return Failure("no sound: this footing-view was built without OpenAL (libopenal-dev)");
}

void Speaker::Play(const std::vector<scene::Sound>& /*sounds*/) {}

#endif

Speaker::Speaker(std::unique_ptr<Device> device) : device_(std::move(device)) {}
Speaker::Speaker(Speaker&&) noexcept = default;
Speaker::~Speaker() = default;

ViewSounds::ViewSounds(bool wanted) {
  if (!wanted) return;
  auto speaker = Speaker::Open();
  if (speaker) {
    speaker_.emplace(std::move(*speaker));
  } else {
    log::Warning(speaker.error().message);
  }
}

std::vector<scene::Sound> ViewSounds::Follow(const std::vector<DrawnView>& views) {
  if (views.empty()) return {};
  const DrawnView& view = views.front();
  const double aspect = view.world.width() / std::max(1.0f, view.world.height());
  std::vector<scene::Sound> sounds = finder_.Advance(view.frame, view.camera, aspect);
  if (speaker_) speaker_->Play(sounds);
  return sounds;
}

}  // namespace footing::view
