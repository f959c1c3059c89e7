// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// Blocks without a page each: the image for 256 KB of flash is told all that it knows, keeps it in
// its flash, and decides as the exact solver does; that of 60 KB takes its id from the chip.
#include <gtest/gtest.h>

#include <filesystem>

#include "holdfast/emulated.hpp"

namespace holdfast {
namespace {

using emulator::EmulationOptions;
using emulator::Fault;

constexpr sim::Time kLook = 5'000;

const emulator::Image& told_image() {
  static const base::Result<emulator::Image> loaded = emulator::load_image(HOLDFAST_IMAGE_TOLD);
  EXPECT_TRUE(loaded) << loaded.error().message;
  return loaded.value();
}

Structure read_structure(const std::string& path) {
  auto structure = load_file(path);
  EXPECT_TRUE(structure);
  return std::move(structure).value();
}

Structure small(const std::string& name) {
  return read_structure(std::string(HOLDFAST_SMALL_DIR) + "/" + name + ".json");
}

emulator::Emulation ended(const emulator::Image& image, const Structure& structure,
                          const EmulationOptions& options) {
  emulator::Emulation emulation(image, structure.robot, options);
  while (emulation.run_for(kLook)) {
  }
  return emulation;
}

void expect_as_exact(const emulator::Emulation& emulation, const Structure& structure) {
  EXPECT_TRUE(emulation.result().all_agree);
  EXPECT_EQ(to_verdict(emulation.result().answer.verdict), check(structure).assessment.verdict);
  EXPECT_EQ(emulation.report().mismatch_count, 0U);
}

std::uint32_t count_of(const Structure& structure) {
  return static_cast<std::uint32_t>(structure.robot.modules().size() -
                                    structure.robot.planned_count());
}

/// Each module writes the robot's numbers once, the anchor and those that are held themselves once.
TEST(Told, robots_without_pages_are_decided_like_the_exact_answer) {
  for (const char* name : {"arm_breaks", "arm_tips", "post_holds"}) {
    SCOPED_TRACE(name);
    const Structure structure = small(name);
    const auto emulation = ended(told_image(), structure, {.is_bare = true});
    expect_as_exact(emulation, structure);
    std::uint32_t held = 0;
    for (const model::Module& module : structure.robot.modules()) {
      held += module.support == model::Support::kFixed ? 1 : 0;
    }
    EXPECT_GE(emulation.report().erase_count, count_of(structure));
    EXPECT_LE(emulation.report().erase_count, count_of(structure) + held + 1);
  }
}

TEST(Told, larger_robots_hand_the_numbers_on) {
  for (const char* name : {"arm_breaks_b", "crane_tips_b"}) {
    SCOPED_TRACE(name);
    const Structure structure =
        read_structure(std::string(HOLDFAST_SCENARIO_DIR) + "/" + name + ".json");
    expect_as_exact(ended(told_image(), structure, {.is_bare = true}), structure);
  }
}

TEST(Told, pages_serve_the_same_image_and_are_not_written_again) {
  const Structure structure = small("arm_breaks");
  const auto emulation = ended(told_image(), structure, {});
  expect_as_exact(emulation, structure);
  EXPECT_EQ(emulation.report().erase_count, 0U);
}

/// Nobody is told anything, as there are no announcements and the time is too short; nobody says
/// safe.
TEST(Told, modules_without_numbers_have_no_verdict) {
  const Structure structure = small("post_holds");
  const auto emulation = ended(told_image(), structure,
                               {.is_bare = true, .tell_at = 5'000'000, .time_max = 2'000'000});
  for (std::int32_t i = 0; i < emulation.module_count(); ++i) {
    EXPECT_EQ(emulation.module(i).answer.verdict, agent::Verdict::kNone);
  }
}

/// What was told is lost with the ring in which it waits; whoever tells it insists, but not here.
/// So up to then the robot may be undecided, and after that it may not.
void reset_while_it_is_told(const Structure& structure, sim::Time begin, bool may_be_undecided) {
  const auto exact = check(structure).assessment.verdict;
  int decided = 0;
  for (sim::Time at = begin; at < begin + 200'000; at += 12'347) {
    SCOPED_TRACE(at);
    EmulationOptions options{.faults = {}, .is_bare = true, .time_max = 25'000'000};
    for (std::int32_t module = 0; module < 3; ++module) {
      options.faults.push_back(
          {.kind = Fault::Kind::kReset, .at = at + 3'001U * module, .module = module});
    }
    const auto emulation = ended(told_image(), structure, options);
    EXPECT_EQ(emulation.report().mismatch_count, 0U);
    for (std::int32_t i = 0; i < emulation.module_count(); ++i) {
      const agent::Verdict verdict = emulation.module(i).answer.verdict;
      const bool is_decided =
          verdict != agent::Verdict::kUndecided && verdict != agent::Verdict::kNone;
      decided += is_decided ? 1 : 0;
      EXPECT_TRUE(is_decided || may_be_undecided) << i;
      EXPECT_TRUE(!is_decided || to_verdict(verdict) == exact) << i;
    }
  }
  EXPECT_GT(decided, 20);
}

TEST(Told, a_reset_at_any_time_never_makes_a_wrong_verdict) {
  reset_while_it_is_told(small("arm_tips"), 60'000, true);
}

/// The module that is held is among those that start again, some of them while they write.
TEST(Told, a_reset_forgets_nothing_that_was_taken) {
  reset_while_it_is_told(small("arm_breaks"), 250'000, false);
}

TEST(Told, what_was_told_outlives_a_reset_of_all_and_wears_no_flash) {
  const Structure structure = small("arm_breaks");
  const auto before = ended(told_image(), structure, {.is_bare = true});
  EmulationOptions options{.faults = {}, .is_bare = true};
  for (std::int32_t i = 0; i < before.module_count(); ++i) {
    options.faults.push_back({.kind = Fault::Kind::kReset, .at = 4'000'000, .module = i});
  }
  const auto after = ended(told_image(), structure, options);
  expect_as_exact(after, structure);
  EXPECT_GT(after.result().time, 4'000'000U);
  EXPECT_EQ(after.report().erase_count, before.report().erase_count);
}

TEST(Told, a_module_that_is_attached_later_is_told_by_its_neighbour) {
  const Structure structure = small("post_holds");
  const auto last = static_cast<std::int32_t>(count_of(structure)) - 1;
  const auto emulation =
      ended(told_image(), structure,
            {.faults = {{.kind = Fault::Kind::kAttach, .at = 2'000'000, .module = last}},
             .is_bare = true});
  expect_as_exact(emulation, structure);
  EXPECT_GT(emulation.result().time, 2'000'000U);
}

TEST(Told, who_cannot_be_told_is_refused_by_name) {
  // The middle of a cross of seven is the first of the file.
  const auto enclosed = load_text(R"({"format": "holdfast-structure", "version": 1, "support_z": 0,
      "modules": [[1,1,1],[0,1,1],[2,1,1],[1,0,1],[1,2,1],[1,1,0],[1,1,2]]})");
  ASSERT_TRUE(enclosed);
  EmulationOptions options{.is_bare = true};
  const auto fault = emulator::find_options_fault(enclosed.value().robot, options);
  ASSERT_TRUE(fault);
  EXPECT_NE(fault->find("(1, 1, 1) has no free face"), std::string::npos) << *fault;
  options.is_bare = false;
  EXPECT_FALSE(emulator::find_options_fault(enclosed.value().robot, options));
  const auto plain = emulator::load_image(HOLDFAST_IMAGE);
  ASSERT_TRUE(plain);
  options.is_bare = true;
  EXPECT_TRUE(emulator::find_image_fault(plain.value(), options));
  EXPECT_FALSE(emulator::find_image_fault(told_image(), options));
}

/// One page for all that are nothing special.
TEST(Told, pages_without_an_id_take_that_of_the_chip) {
  for (const char* path : {HOLDFAST_IMAGE, HOLDFAST_IMAGE_TOLD}) {
    const auto image = emulator::load_image(path);
    ASSERT_TRUE(image);
    const Structure structure = small("arm_breaks");
    expect_as_exact(ended(image.value(), structure, {.has_ids = false}), structure);
  }
}

}  // namespace
}  // namespace holdfast
