// SPDX-License-Identifier: Apache-2.0
// moraine profile: of a real run, as text, JSON and page; and what every run says without a trace.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/support/shell.hpp"
#include "tests/unit/scene_text.hpp"

namespace moraine {
namespace {

using Json = nlohmann::json;
using test::Ended;
using test::shell;

std::string text_of(const std::filesystem::path& file) {
  std::ostringstream out;
  out << std::ifstream(file).rdbuf();
  return out.str();
}

class ProfileCommand : public testing::Test {
 protected:
  std::string in(const std::string& name) const { return (root_ / name).string(); }
  void run(const std::string& trace) {
    const Ended e = shell("moraine run " MORAINE_SOURCE_DIR
                          "/apps/scenes/dam.yaml --set count=600 --sub-models 7 --steps 60 --threads 2 "
                          "--scheduler barrier --quiet --set output.pictures=false --out " +
                          in("out") + " --trace " + in(trace));
    ASSERT_EQ(e.status, 0) << e.text;
  }
  Ended profile(const std::string& options) const { return shell("moraine profile " + options + " 2>/dev/null"); }

  Folder folder_;
  std::filesystem::path root_ = folder_.write("empty", "").parent_path();
};

TEST_F(ProfileCommand, SaysTheSameOfBothForms) {
  run("run.trace");
  const Ended compact = profile(in("run.trace") + " --json");
  ASSERT_EQ(compact.status, 0) << compact.text;
  const Json json = Json::parse(compact.text);
  EXPECT_EQ(json.at("sub_models"), 7);
  EXPECT_EQ(json.at("stages").size(), 4U);
  const Json& all = json.at("all");
  double total = 0;
  for (const char* what : {"busy_s", "imbalance_s", "messages_s", "scheduling_s", "between_s"})
    total += all.at(what).get<double>();
  EXPECT_NEAR(total, 2 * json.at("elapsed_s").get<double>(), 0.02 * total);
  for (const char* counter : {"elements", "contacts", "ghosts"}) {
    double sum = 0;
    for (const Json& s : json.at("sub_models_s")) sum += s.at("counters").at(counter).get<double>();
    EXPECT_GT(sum, 0) << counter;
  }
  const Json& path = json.at("critical_path");
  EXPECT_LE(path.at("tasks_s").get<double>(), json.at("elapsed_s").get<double>());
  EXPECT_NE(json.at("sentence").get<std::string>().find("of the run time was spent waiting"), std::string::npos);
  EXPECT_FALSE(json.at("tried").empty());
  run("run.json");
  const Ended chrome = profile(in("run.json") + " --json");
  ASSERT_EQ(chrome.status, 0) << chrome.text;
  EXPECT_EQ(Json::parse(chrome.text).at("tasks"), json.at("tasks"));
}

TEST_F(ProfileCommand, PrintsTables) {
  run("run.trace");
  const Ended e = profile(in("run.trace"));
  ASSERT_EQ(e.status, 0) << e.text;
  for (const char* part :
       {"ghost_build", "imbalance %", "critical path", "waited for", "replayed with", "spent waiting"})
    EXPECT_NE(e.text.find(part), std::string::npos) << part << "\n" << e.text;
}

TEST_F(ProfileCommand, WritesAPageThatNeedsNothingElse) {
  run("run.trace");
  ASSERT_EQ(profile(in("run.trace") + " --html " + in("page.html")).status, 0);
  const std::string page = text_of(in("page.html"));
  EXPECT_EQ(page.find("http"), std::string::npos) << "no network";
  const std::string open = R"(<script type="application/json" id="data">)";
  const std::size_t at = page.find(open) + open.size(), end = page.find("</script>", at);
  const Json data = Json::parse(page.substr(at, end - at));
  const std::size_t tasks = data.at("report").at("tasks");
  EXPECT_EQ(data.at("tasks").at("start").get<std::string>().size(), (tasks * 8 + 2) / 3 * 4) << "base64 of doubles";
  EXPECT_EQ(data.at("tasks").at("stage").get<std::string>().size(), (tasks + 2) / 3 * 4);
  std::size_t in_rows = 0;
  for (const Json& row : data.at("rows")) in_rows += row.at("count").get<std::size_t>();
  EXPECT_EQ(in_rows, tasks);
  EXPECT_FALSE(data.at("path").at("task").get<std::string>().empty());
}

TEST_F(ProfileCommand, RefusesWhatItCannotRead) {
  const Ended none = shell("moraine profile " + in("none.trace"));
  EXPECT_EQ(none.status, 2) << none.text;
  EXPECT_NE(none.text.find("none.trace"), std::string::npos);
  run("run.trace");
  const Ended nowhere = shell("moraine profile " + in("run.trace") + " --html " + in("no/such/page.html"));
  EXPECT_EQ(nowhere.status, 2) << nowhere.text;
  EXPECT_NE(nowhere.text.find("page.html"), std::string::npos);
}

TEST_F(ProfileCommand, EveryRunSaysWhereItsTimeWent) {
  const Ended e =
      shell("moraine run " MORAINE_SOURCE_DIR
            "/apps/scenes/uneven.yaml --set count=20 --steps 30 --threads 2 --set output.pictures=false --out " +
            in("out"));
  ASSERT_EQ(e.status, 0) << e.text;
  EXPECT_NE(e.text.find("of the run time was spent waiting"), std::string::npos) << e.text;
  const Json load = Json::parse(std::ifstream(in("out/summary.json"))).at("load");
  double shares = 0;
  for (const Json& what : load.at("time")) shares += what.at("mean").get<double>();
  EXPECT_NEAR(shares, 1, 1e-6);
  EXPECT_EQ(load.at("costliest").size(), 3U);
  EXPECT_GE(load.at("costliest").at(0).at("share"), load.at("costliest").at(1).at("share"));
  EXPECT_FALSE(load.at("sentence").get<std::string>().empty());
  for (const char* key : {"imbalance", "utilisation", "waiting_fraction", "migrations", "cure"})
    EXPECT_TRUE(load.contains(key)) << key;
}

}  // namespace
}  // namespace moraine
