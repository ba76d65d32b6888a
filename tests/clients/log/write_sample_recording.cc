#include "tests/clients/log/sample_recording.h"

/// write_sample_recording FILE.mcap [zstd]
int main(int argc, char** argv) {
  if (argc != 2 && argc != 3) return 2;
  footing::log_client::WriteSampleRecording(argv[1], true, /*compress=*/argc == 3);
  return 0;
}
