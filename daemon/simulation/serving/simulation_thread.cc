#include "daemon/simulation/serving/simulation_thread.h"

namespace footing::serving {

void Config::Bind(config::Binder& binder) {
  binder.Text("sensor", sensor, "Address of footingd");
  binder.TextList("listen", listen,
                  "Addresses for clients, unix:PATH, tcp:HOST:PORT or tls:HOST:PORT");
  binder.Text("rig", rig, "Rig to follow (empty: the first with hand devices, or with boards)");
  binder.Text("data_folder", data_folder,
              "Folder with biped.json, the mappings, the models and the tracks");
  access.Bind(binder);
  binder.Text("metrics", metrics,
              "Address of the metrics for Prometheus, tcp:127.0.0.1:PORT or unix:PATH (empty: "
              "none)");
  sessions.Bind(binder);
}

}  // namespace footing::serving
