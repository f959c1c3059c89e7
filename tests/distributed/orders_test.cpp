// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// What the root orders after what: the table of docs/distributed.md, against the orders that cross
// the lines of whole runs. Each line from a parent to a child carries all orders of a round.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <sstream>

#include "general_robot.hpp"
#include "holdfast/agent/wire/operations.hpp"
#include "holdfast/agent/wire/wire.hpp"
#include "holdfast/holdfast.hpp"
#include "holdfast/model/families.hpp"
#include "holdfast/sim/simulation.hpp"
#include "holdfast/sim/trace.hpp"
#include "random_robot.hpp"
#include "seeds.hpp"

namespace holdfast {
namespace {

namespace wire = agent::wire;

using Pairs = std::set<std::pair<std::string, std::string>>;

const char* name_of(std::uint8_t operation) {
  for (const agent::OperationInfo& info : agent::kOperations) {
    if (static_cast<std::uint8_t>(info.operation) == operation) {
      return info.name;
    }
  }
  return "unknown";
}

/// Follows the stream of every line and notes which order comes behind which.
class OrderWatch : public sim::TraceSink {
 public:
  explicit OrderWatch(Pairs& pairs) : pairs_(pairs) {}

  void packet_sent(const sim::PacketTrace& packet, sim::Time /*line_time*/) override {
    if (static_cast<wire::PacketKind>(packet.bytes[0] >> 6U) != wire::PacketKind::kData) {
      return;
    }
    Line& line = lines_[{packet.from, packet.to}];
    const int sequence = packet.bytes[0] & 63U;
    if (sequence != line.next_sequence) {
      return;  // Sent again.
    }
    line.next_sequence = (sequence + 1) % 64;
    line.stream.insert(line.stream.end(), packet.bytes.begin() + wire::kHeaderBytes,
                       packet.bytes.end() - wire::kChecksumBytes);
    take(line);
  }

 private:
  struct Line {
    int next_sequence = 0;
    std::vector<std::uint8_t> stream;
    std::string last;
  };

  void take(Line& line) {
    while (line.stream.size() >= 2) {
      const int size = wire::message_bytes(line.stream[0], line.stream[1]);
      ASSERT_GT(size, 0);
      if (line.stream.size() < static_cast<std::size_t>(size)) {
        return;
      }
      const auto type = static_cast<wire::MessageType>(line.stream[0]);
      if (type == wire::MessageType::kJoin) {
        line.last.clear();  // Another round.
      } else if (type == wire::MessageType::kOrder) {
        const std::string next = name_of(line.stream[1]);
        if (!line.last.empty()) {
          pairs_.emplace(line.last, next);
        }
        line.last = next;
      }
      line.stream.erase(line.stream.begin(), line.stream.begin() + size);
    }
  }

  Pairs& pairs_;
  std::map<std::pair<std::int32_t, std::int32_t>, Line> lines_;
};

std::vector<std::string> words_of(const std::string& cell) {
  std::vector<std::string> words;
  std::istringstream in(cell);
  for (std::string word; std::getline(in, word, ',');) {
    const std::size_t first = word.find_first_not_of(' ');
    words.push_back(word.substr(first, word.find_last_not_of(' ') + 1 - first));
  }
  return words;
}

/// The table's pairs.
Pairs read_table() {
  std::ifstream file(HOLDFAST_DISTRIBUTED_FILE);
  const std::string page(std::istreambuf_iterator<char>(file), {});
  std::istringstream lines(page.substr(page.find("| after the report of |")));
  Pairs pairs;
  std::string line;
  std::getline(lines, line);
  std::getline(lines, line);
  while (std::getline(lines, line) && line.starts_with("| ")) {
    const std::size_t middle = line.find(" | ");
    for (const std::string& before : words_of(line.substr(2, middle - 2))) {
      for (const std::string& after : words_of(line.substr(middle + 3, line.size() - middle - 5))) {
        pairs.emplace(before, after);
      }
    }
  }
  return pairs;
}

void watch(const model::Robot& robot, agent::Method method, Pairs& pairs,
           std::vector<sim::Announcement> announcements = {}) {
  OrderWatch orders(pairs);
  sim::SimulationOptions options{.method = method, .trace = &orders};
  options.announcements = std::move(announcements);
  options.watch_for = 1000;
  sim::Simulation(robot, options).run();
}

/// Random robots; all that need the exact contact law, and some others.
void watch_random_robots(Pairs& pairs) {
  for (std::uint64_t seed = 0; seed < test::campaign(400U); ++seed) {
    const model::Robot robot = model::Robot::create(test::random_robot(seed, 3, 16)).value();
    const bool is_exact =
        verdict::assess(robot).contact_model == verdict::ContactModel::kUnilateral;
    if (is_exact || seed < test::campaign(40U)) {
      watch(robot, agent::Method::kElimination, pairs);
      watch(robot, agent::Method::kFronts, pairs);
    }
  }
}

/// Watches a module on a beam move on by a cell.
void watch_step(const model::Robot& robot, Pairs& pairs) {
  using Kind = agent::StepWord::Kind;
  OrderWatch orders(pairs);
  sim::SimulationOptions options{.trace = &orders};
  options.step = {{.kind = Kind::kMove, .face = 5, .first = 0, .cell = {0, 0, 3}},
                  {.kind = Kind::kCarry, .mask = 3, .cell = {0, 0, 2}},
                  {.kind = Kind::kCarry, .mask = 6, .cell = {1, 0, 2}}};
  sim::Simulation(robot, options).run();
}

/// Plans on top of towers, whose bending every one of them would find again if modules did not keep
/// how they have moved, as they do where layers are odd; in the end the first module comes.
void watch_deflated(Pairs& pairs) {
  for (const int height : {4, 5, 7, 8, 9}) {
    OrderWatch orders(pairs);
    sim::SimulationOptions options{.deflates = height % 2 != 0, .trace = &orders};
    options.watch_for = 2000;
    for (int i = 0; i < agent::kPlannedMax; ++i) {
      options.announcements.push_back({.at = 3000 * static_cast<sim::Time>(i + 1),
                                       .module = 1,
                                       .cell = {i % 3, i / 3, height}});
    }
    auto tower = model::family_cells(model::Family::kTower, base::at(height));
    const auto last = static_cast<std::int32_t>(tower.size());
    tower.push_back({0, 0, height});
    options.absent = {last};
    options.faults = {{.kind = sim::Fault::Kind::kAttach, .at = 20'000, .module = last}};
    const model::Robot robot = model::Robot::create({.existing = tower}).value();
    sim::Simulation(robot, options).run();
  }
}

TEST(Orders, follow_each_other_as_the_document_says) {
  const Pairs table = read_table();
  ASSERT_GT(table.size(), 40U);
  Pairs seen;
  for (const auto& file : std::filesystem::directory_iterator(HOLDFAST_SCENARIO_DIR)) {
    if (file.path().extension() == ".json") {
      const Structure structure = load_file(file.path()).value();
      watch(structure.robot, agent::Method::kElimination, seen);
      watch(structure.robot, agent::Method::kPolynomial, seen);
    }
  }
  watch_random_robots(seen);
  for (std::uint64_t seed = 0; seed < test::campaign(12U); ++seed) {
    const auto robot = model::Robot::create(test::general_robot(base::kCubic, seed));
    watch(robot.value(), agent::Method::kElimination, seen);
  }
  const std::filesystem::path folder = HOLDFAST_SCENARIO_DIR;
  const Structure arm = load_file(folder / "arm_tips_a.json").value();
  // Plans that are withdrawn later; a tree so deep that there are clusters.
  watch(arm.robot, agent::Method::kElimination, seen,
        {{.at = 2000, .module = 1, .cell = agent::kEveryCell, .is_withdrawal = true}});
  // Plans that are renewed verdicts: by elimination, by iterations, and told of twice.
  watch(arm.robot, agent::Method::kElimination, seen,
        {{.at = 2000, .module = 1, .cell = {5, 1, 3}},
         {.at = 4000, .module = 1, .cell = {5, 1, 3}, .is_withdrawal = true}});
  const auto cube = model::family_cells(model::Family::kCube, 3);
  watch(
      model::Robot::create({.existing = cube}).value(), agent::Method::kElimination, seen,
      {{.at = 2000, .module = 1, .cell = {0, 0, 3}}, {.at = 2000, .module = 1, .cell = {2, 2, 3}}});
  watch_step(load_file(folder / "plan" / "walk_over_beam.json").value().robot, seen);
  watch_deflated(seen);
  EXPECT_TRUE(seen.contains({"resume deflated", "iterate deflated"}));
  EXPECT_TRUE(seen.contains({"iterate deflated", "iterate last"}));
  // Free faces: whatever would be followed by the verdict is followed by these.
  const model::Robot judging = model::Robot::create({.existing = cube}).value();
  OrderWatch orders(seen);
  sim::Simulation(judging, {.judges_faces = true, .trace = &orders}).run();
  const auto tower = model::family_cells(*model::find_family("tower"), 135);
  watch(model::Robot::create({.existing = tower}).value(), agent::Method::kElimination, seen);

  // The same cube where somebody says how soft it is.
  watch(model::Robot::create({.existing = cube, .is_modulus_stated = true}).value(),
        agent::Method::kElimination, seen);

  for (const auto& [before, after] : seen) {
    // In a stage of a step that order is in the place of a verdict.
    EXPECT_TRUE(table.contains({before, after}) || after == "verdict" || after == "stage" ||
                after == "shape" || after == "bend")
        << before << ", " << after;
  }
  // Every row is taken. Not all that it has are seen: feet without a state are rare.
  std::size_t shown = 0;
  for (const auto& row : table) {
    shown += seen.contains(row) ? 1 : 0;
    const bool is_taken =
        std::ranges::any_of(seen, [&](const auto& pair) { return pair.first == row.first; });
    EXPECT_TRUE(is_taken || test::kIsShort) << row.first;
  }
  EXPECT_GT(shown, (test::kIsShort ? 2 : 3) * table.size() / 4);
}

}  // namespace
}  // namespace holdfast
