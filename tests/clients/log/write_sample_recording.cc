#include <string>

#include "tests/clients/log/sample_recording.h"

/// write_sample_recording FILE.mcap [zstd|scene]
int main(int argc, char** argv) {
  if (argc != 2 && argc != 3) return 2;
  if (argc == 3 && argv[2] == std::string("scene")) {
    footing::log_client::WriteSceneRecording(argv[1]);
  } else {
    footing::log_client::WriteSampleRecording(argv[1], true, /*compress=*/argc == 3);
  }
  return 0;
}
