#include "daemon/offline/tune/kept_run.h"

#include <nlohmann/json.hpp>

namespace footing::tune {
namespace {

using nlohmann::json;

json ToJson(const RunKey& key) {
  return {{"gait", key.gait},     {"speeds_mps", key.speeds_mps}, {"seed", key.seed},
          {"method", key.method}, {"trials", key.trials},         {"step", key.step},
          {"from", key.from}};
}

std::vector<double> Numbers(const Eigen::MatrixXd& matrix) {
  return {matrix.data(), matrix.data() + matrix.size()};
}

json ToJson(const SearchState& search) {
  json history = json::array();
  for (const HistoryPoint& point : search.history) {
    history.push_back({point.iteration, point.objective, point.best});
  }
  return {{"iteration", search.iteration},
          {"point", Numbers(search.point)},
          {"step", search.step},
          {"covariance", Numbers(search.covariance)},
          {"covariance_path", Numbers(search.covariance_path)},
          {"step_path", Numbers(search.step_path)},
          {"history", history}};
}

Eigen::MatrixXd Matrix(const json& numbers, Eigen::Index rows, Eigen::Index columns) {
  const auto values = numbers.get<std::vector<double>>();
  if (static_cast<Eigen::Index>(values.size()) != rows * columns)
    throw json::other_error::create(501, "wrong size", nullptr);
  return Eigen::Map<const Eigen::MatrixXd>(values.data(), rows, columns);
}

SearchState FromJson(const json& kept) {
  SearchState search;
  search.iteration = kept.at("iteration");
  search.step = kept.at("step");
  const auto n = static_cast<Eigen::Index>(kept.at("point").size());
  search.point = Matrix(kept.at("point"), n, 1);
  search.covariance = Matrix(kept.at("covariance"), n, n);
  search.covariance_path = Matrix(kept.at("covariance_path"), n, 1);
  search.step_path = Matrix(kept.at("step_path"), n, 1);
  for (const json& point : kept.at("history")) {
    search.history.push_back({point.at(0), point.at(1), point.at(2)});
  }
  return search;
}

}  // namespace

std::string KeepRun(const RunKey& key, const std::vector<SearchState>& searches) {
  json kept = {{"version", 1}, {"key", ToJson(key)}, {"searches", json::array()}};
  for (const SearchState& search : searches) kept["searches"].push_back(ToJson(search));
  return kept.dump(1) + "\n";
}

Result<std::vector<SearchState>> ResumeRun(const std::string& text, const RunKey& key,
                                           const std::string& path) {
  const json kept = json::parse(text, nullptr, false);
  if (!kept.is_object() || !kept.contains("key") || !kept["key"].is_object()) {
    return InvalidData(path + " is not a state file of footing-tune; remove it to start again");
  }
  const json wanted = ToJson(key);
  for (const auto& [name, value] : wanted.items()) {
    if (kept["key"].value(name, json()) == value) continue;
    return InvalidData(path + " is of a run with another " + name +
                       "; remove it to start again, or name another --out");
  }
  try {
    std::vector<SearchState> searches;
    for (const json& search : kept.at("searches")) searches.push_back(FromJson(search));
    return searches;
  } catch (const json::exception& error) {
    return InvalidData(path + " is damaged (" + error.what() + "); remove it to start again");
  }
}

}  // namespace footing::tune
