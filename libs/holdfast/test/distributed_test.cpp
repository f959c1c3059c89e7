// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// The second half of the facade: simulate, report, draw.
#include "holdfast/distributed.hpp"

#include <gtest/gtest.h>

#include <string>

#include "random_robot.hpp"

namespace holdfast {
namespace {

/// A post of two with two modules to be attached side by side: 1.5 modules of weight at one pitch.
constexpr const char* kPost =
    R"({"format": "holdfast-structure", "version": 1,
        "modules": [[0,0,0],[1,0,0],[2,0,0],[1,0,1]], "planned": [[2,0,1],[2,1,1]]})";

Structure post() {
  auto structure = load_text(kPost, "post");
  EXPECT_TRUE(structure);
  return std::move(structure).value();
}

TEST(Simulate, gives_the_exact_verdict_and_load_ratios_of_every_connection) {
  const Structure structure = post();
  const CheckResult exact = check(structure);
  const auto run = simulate(structure, exact, {});
  ASSERT_TRUE(run);
  const DistributedRun& found = run.value();
  EXPECT_TRUE(found.result.is_quiet);
  EXPECT_TRUE(found.result.all_agree);
  EXPECT_EQ(found.view.verdict, exact.assessment.verdict);
  ASSERT_EQ(found.view.connections.size(), exact.assessment.connections.size());
  for (std::size_t i = 0; i < found.view.connections.size(); ++i) {
    EXPECT_NEAR(found.view.connections[i].load_ratio, exact.assessment.connections[i].load_ratio,
                0.01)
        << model::ends_text(structure.robot, i);
  }
}

TEST(Simulate, says_what_is_wrong_with_the_options) {
  const Structure structure = post();
  sim::SimulationOptions options;
  options.link.loss = 2;
  const auto run = simulate(structure, check(structure), options);
  ASSERT_FALSE(run);
  EXPECT_NE(run.error().message.find("loss"), std::string::npos) << run.error().message;
}

/// A random robot without planned modules, of whose pairs every second one that can be open is.
model::RobotSpec robot_with_open_pairs(std::uint64_t seed) {
  model::RobotSpec spec = test::random_robot(seed, 4, 20);
  spec.planned.clear();
  model::forget_absent(spec);
  const auto whole = model::Robot::create(spec);
  EXPECT_TRUE(whole);
  for (std::size_t i = seed % 2; whole && i < whole.value().connections().size(); i += 2) {
    const model::Connection pair = whole.value().connections()[i];
    spec.released.push_back({whole.value().modules()[static_cast<std::size_t>(pair.a)].cell,
                             whole.value().modules()[static_cast<std::size_t>(pair.b)].cell});
    if (!model::Robot::create(spec) || spec.released.size() > agent::kWordCountMax) {
      spec.released.pop_back();
    }
  }
  return spec;
}

TEST(Simulate, knows_open_pairs_as_the_exact_answer_does) {
  std::size_t open_count = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const auto robot = model::Robot::create(robot_with_open_pairs(seed));
    ASSERT_TRUE(robot);
    const CheckResult exact = check(robot.value());
    const auto run = simulate(robot.value(), exact, {.seed = seed});
    ASSERT_TRUE(run) << run.error().message;
    EXPECT_TRUE(run.value().result.all_agree);
    EXPECT_EQ(run.value().view.verdict, exact.assessment.verdict) << seed;
    // Where the regularised law has no answer, or several, the modules may find another one.
    const bool is_one = exact.assessment.contact_model == verdict::ContactModel::kRegularised &&
                        !exact.assessment.several;
    for (std::size_t i = 0; is_one && i < run.value().view.connections.size(); ++i) {
      EXPECT_NEAR(run.value().view.connections[i].load_ratio,
                  exact.assessment.connections[i].load_ratio, 0.01)
          << seed << ": " << model::ends_text(robot.value(), i);
    }
    open_count += robot.value().released_count();
  }
  EXPECT_GT(open_count, 100U);
}

/// More than modules keep in mind are refused by number, as are planned modules beside open pairs.
TEST(Simulate, refuses_open_pairs_that_modules_cannot_know) {
  std::string cells = "[0,0,0]";
  std::string open;
  for (int i = 1; i < 20; ++i) {
    const std::string x = std::to_string(i);
    cells += ",[" + x + ",0,0],[" + x + ",0,1]";
    open += std::string(i > 1 ? "," : "") + "[[" + x + ",0,0],[" + x + ",0,1]]";
  }
  const std::string head = R"({"format": "holdfast-structure", "version": 2, "modules": [)";
  const auto message_of = [](const std::string& text) {
    const auto structure = load_text(text, "open");
    EXPECT_TRUE(structure) << structure.error().message;
    const auto run = simulate(structure.value(), check(structure.value()), {});
    return run ? "no error" : run.error().message;
  };
  EXPECT_NE(message_of(head + cells + ",[0,0,1]], \"open\": [" + open + "]}").find("19 words"),
            std::string::npos);
  EXPECT_NE(message_of(head + R"([0,0,0],[0,0,1],[1,0,0],[1,0,1]], "planned": [[0,0,2]],
                                "open": [[[0,0,1],[1,0,1]]]})")
                .find("simulate --stages"),
            std::string::npos);
}

/// The exact answer is given another law here; the robot's is the regularised one.
TEST(Simulate, says_so_if_its_load_ratios_are_those_of_another_contact_law) {
  const Structure structure = post();
  CheckResult exact = check(structure);
  ASSERT_EQ(exact.assessment.contact_model, verdict::ContactModel::kRegularised);
  const auto same = simulate(structure, exact, {});
  ASSERT_TRUE(same);
  EXPECT_TRUE(same.value().notes.empty());
  exact.assessment.contact_model = verdict::ContactModel::kUnilateral;
  const auto other = simulate(structure, exact, {});
  ASSERT_TRUE(other);
  ASSERT_EQ(other.value().notes.size(), 1U);
  EXPECT_NE(report_text(structure, exact, other.value()).find("another contact law"),
            std::string::npos);
}

/// A module that was taken off can neither fall silent nor be taken off; before, it can, and again
/// when it has been put on.
TEST(Simulate, says_what_was_to_happen_to_modules_that_are_not_there) {
  using Happening = sim::Fault::Kind;
  const Structure structure = post();
  const CheckResult exact = check(structure);
  const auto notes_of = [&](std::vector<sim::Fault> faults) {
    const auto run = simulate(structure, exact, {.faults = std::move(faults)});
    return run ? run.value().notes : std::vector<std::string>();
  };
  const std::string nothing = ": nothing came of that";
  const std::vector<std::string> gone =
      notes_of({{.kind = Happening::kKill, .at = 9000, .module = 2},
                {.kind = Happening::kDetach, .at = 10, .module = 2}});
  ASSERT_EQ(gone.size(), 2U);
  EXPECT_EQ(gone[1], "(2,0,0) was not there when it was to fall silent" + nothing);
  const std::vector<std::string> twice =
      notes_of({{.kind = Happening::kDetach, .at = 10, .module = 2},
                {.kind = Happening::kDetach, .at = 10, .module = 2}});
  ASSERT_EQ(twice.size(), 2U);
  EXPECT_EQ(twice[1], "(2,0,0) was not there when it was to be taken off" + nothing);
  EXPECT_EQ(notes_of({{.kind = Happening::kKill, .at = 5, .module = 2},
                      {.kind = Happening::kDetach, .at = 10, .module = 2}})
                .size(),
            1U);
  EXPECT_EQ(notes_of({{.kind = Happening::kDetach, .at = 10, .module = 2},
                      {.kind = Happening::kAttach, .at = 20, .module = 2},
                      {.kind = Happening::kKill, .at = 9000, .module = 2}})
                .size(),
            1U);
}

TEST(Simulate, ends_when_the_caller_says_so_and_claims_nothing_then) {
  // A plate of 400, which sends many more packets than there are between two calls.
  std::string cells = R"({"cell": [0,0,0], "fixed": true})";
  for (int i = 1; i < 400; ++i) {
    cells += ", [" + std::to_string(i % 20) + "," + std::to_string(i / 20) + ",0]";
  }
  const auto plate = load_text(
      R"({"format": "holdfast-structure", "version": 1, "modules": [)" + cells + "]}", "plate");
  ASSERT_TRUE(plate) << plate.error().message;
  int calls = 0;
  const auto run =
      simulate(plate.value(), check(plate.value()), {}, [&](const sim::SimulationResult& result) {
        EXPECT_GT(result.events, 0U);
        return ++calls < 2;
      });
  ASSERT_TRUE(run);
  EXPECT_EQ(calls, 2);
  EXPECT_EQ(run.value().view.verdict, verdict::Verdict::kUndecided);
  EXPECT_FALSE(run.value().result.is_quiet);
}

// The modules' bounds say no more than the exact answer; images for real modules know nothing of
// bending, without which a pole of any height stands.
TEST(Simulate, is_undecided_where_what_modules_call_safe_bends_away) {
  int undecided = 0;
  for (const double modulus : {1.0, 4.0, 1e6}) {
    for (int height : {3, 10, 30}) {
      std::string cells;
      for (int z = 0; z < height; ++z) {
        cells += (z > 0 ? ", " : "") + std::string("[0,0,") + std::to_string(z) + "]";
      }
      const auto pole =
          load_text(R"({"format": "holdfast-structure", "version": 2, "material": {)" +
                        std::string(R"("elastic_modulus_mpa": )") + std::to_string(modulus) +
                        R"(}, "modules": [)" + cells + "]}",
                    "pole");
      ASSERT_TRUE(pole) << pole.error().message;
      const CheckResult exact = check(pole.value());
      const bool is_undecided = exact.assessment.verdict == verdict::Verdict::kUndecided;
      const auto run = simulate(pole.value(), exact, {});
      ASSERT_TRUE(run);
      const bool is_refused = run.value().result.answer.reason == agent::Reason::kSecondOrder;
      EXPECT_TRUE(is_refused || !is_undecided) << modulus << " " << height;
      EXPECT_EQ(run.value().result.answer.verdict,
                is_refused ? agent::Verdict::kUndecided : agent::Verdict::kSafe);
      const auto image = simulate(pole.value(), exact, {.only_one_sweep = true});
      ASSERT_TRUE(image);
      EXPECT_EQ(image.value().result.answer.verdict, agent::Verdict::kSafe);
      EXPECT_EQ(image.value().view.verdict, exact.assessment.verdict) << modulus << " " << height;
      undecided += is_undecided ? 1 : 0;
    }
  }
  EXPECT_GE(undecided, 2);
  EXPECT_LE(undecided, 6);
}

TEST(Simulate, reports_what_it_found_beside_the_exact_answer) {
  const Structure structure = post();
  const CheckResult exact = check(structure);
  const auto run = simulate(structure, exact, {.link = sim::blinky_blocks_v1()});
  ASSERT_TRUE(run);
  const std::string json = report_json(structure, exact, run.value());
  for (const char* key : {"\"distributed\"",
                          "\"verdict\"",
                          "\"load_ratio_max\"",
                          "\"method\"",
                          "\"rounds\"",
                          "\"simulated_s\"",
                          "\"messages\"",
                          "\"bytes\"",
                          "\"iterations\"",
                          "\"bytes_per_module\"",
                          "\"all_modules_agree\"",
                          "\"discovery\"",
                          "\"coordinates\"",
                          "\"election\"",
                          "\"tree\"",
                          "\"mass\"",
                          "\"simplified\"",
                          "\"equilibrium\"",
                          "\"model\"",
                          "\"overload\""}) {
    EXPECT_NE(json.find(key), std::string::npos) << key;
  }
  EXPECT_NE(report_text(structure, exact, run.value()).find("all modules agree"),
            std::string::npos);
  EXPECT_NE(picture_svg(structure, run.value()).find("</svg>"), std::string::npos);
}

TEST(Methods, have_names_that_are_found_again) {
  for (const agent::Method method :
       {agent::Method::kElimination, agent::Method::kPolynomial, agent::Method::kFronts}) {
    EXPECT_EQ(find_method(name(method)), method);
  }
  EXPECT_FALSE(find_method("magic"));
}

}  // namespace
}  // namespace holdfast
