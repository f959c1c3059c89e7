// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/stages.hpp"

#include "holdfast/mechanics/connector.hpp"

namespace holdfast::agent {
namespace {

using base::Cell;
using base::Direction;
using Kind = StepWord::Kind;

constexpr std::uint8_t bit(int index) { return static_cast<std::uint8_t>(1U << unsigned(index)); }

/// What is worse, the larger.
int severity(Verdict verdict) {
  switch (verdict) {
    case Verdict::kUnstable:
      return 3;
    case Verdict::kOverload:
      return 2;
    case Verdict::kUndecided:
      return 1;
    default:
      return 0;
  }
}

/// Twice the place of a moved module at a waypoint, from a cell.
std::array<std::int32_t, 3> doubled_place(const StepWord& move, int waypoint, const Cell& from) {
  const Cell way = doubled_way(move, waypoint);
  return {2 * (move.cell.x - from.x) + way.x, 2 * (move.cell.y - from.y) + way.y,
          2 * (move.cell.z - from.z) + way.z};
}

/// Twice the unit vector of a direction.
std::array<std::int32_t, 3> doubled_unit(Direction direction) {
  const Cell unit = base::neighbour({}, direction);
  return {2 * unit.x, 2 * unit.y, 2 * unit.z};
}

std::int32_t square_between(const std::array<std::int32_t, 3>& a,
                            const std::array<std::int32_t, 3>& b) {
  std::int32_t sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    sum += (a[i] - b[i]) * (a[i] - b[i]);
  }
  return sum;
}

}  // namespace

// ---- What this module was told.

void Stages::tell(std::uint8_t index, std::uint8_t total, const StepWord& word) {
  if (index == 0 || total != told_total_ || is_known_) {
    forget_told(false);
  }
  told_total_ = total;
  if (total > kWordCountMax || index >= total || !is_word(bits_of(word))) {
    return;  // Such a plan is never whole.
  }
  words_[index] = word;
  told_ = static_cast<std::uint16_t>(told_ | 1U << index);
}

void Stages::forget_told(bool only_known) {
  if (!only_known || is_known_) {
    told_ = 0;
    told_total_ = 0;
    is_known_ = false;
  }
}

// ---- What the robot has learned.

void Stages::leave(const Round& round) {
  learned_ = 0;
  total_ = 0;
  is_disputed_ = false;
  stage_ = Stage::kNone;
  split_ = split_round_ == round ? split_ : Stage::kNone;
  scene_ = 0;
}

void Stages::learn(std::uint8_t index, std::uint8_t total, const StepWord& word) {
  total_ = total;
  learned_ = static_cast<std::uint8_t>(index + 1);
  const bool was_told = (told_ >> index & 1U) != 0;
  if (told_ != 0 && (told_total_ != total || (was_told && !(words_[index] == word)))) {
    is_disputed_ = true;
  } else {
    words_[index] = word;
  }
  is_known_ = is_known_ || learned_ == total_;
}

Report Stages::report(std::uint8_t index, const StageSite& site) const {
  Report report{.flags = is_disputed_ ? kDisputed : std::uint8_t{0}};
  const auto next = static_cast<std::uint8_t>(index == kNoWord ? 0 : index + 1);
  if (index != kNoWord && next == total_) {
    for (int i = 0; i < total_; ++i) {
      const StepWord& mine = word(i);
      const bool is_named = mine.cell == site.cell && mine.kind != Kind::kAttach;
      const bool is_denied = is_named ? !fits(mine, site) : is_in_the_way(mine, site);
      report.flags = static_cast<std::uint8_t>(report.flags | (is_denied ? kDenied : 0U));
      report.count += is_named ? 1 : 0;
    }
    report.flags = static_cast<std::uint8_t>(report.flags | (split_ != Stage::kNone ? kSplit : 0U));
    report.mask = static_cast<std::uint8_t>(split_);
  } else if (next < kWordCountMax && (told_ >> next & 1U) != 0) {
    report.flags = static_cast<std::uint8_t>(report.flags | kFound);
    report.cell = words_[next].cell;
    report.number = bits_of(words_[next]);
    report.extent = told_total_;
  }
  return report;
}

/// What is said of this module must be possible here.
bool Stages::fits(const StepWord& word, const StageSite& site) const {
  const bool leaves = word.kind == Kind::kDetach || word.kind == Kind::kMove;
  if (leaves && (site.is_fixed || find(word.kind, site.cell) != &word ||
                 (word.kind == Kind::kMove && find(Kind::kDetach, site.cell) != nullptr))) {
    return false;  // It is held, or goes twice.
  }
  return word.kind == Kind::kCarry || site.used.has(static_cast<Direction>(word.face));
}

/// A module that stays in a cell that another one needs, or stands on the ground above it.
bool Stages::is_in_the_way(const StepWord& word, const StageSite& site) const {
  const bool stays =
      find(Kind::kMove, site.cell) == nullptr && find(Kind::kDetach, site.cell) == nullptr;
  if (!stays || (word.kind != Kind::kMove && word.kind != Kind::kAttach)) {
    return false;
  }
  const Cell target = word.kind == Kind::kMove ? target_of(word) : word.cell;
  const bool is_below = target == base::neighbour(site.cell, Direction::kMinusZ);
  const bool is_passed =
      word.kind == Kind::kMove &&
      site.cell == base::neighbour(word.cell, static_cast<Direction>(word.first));
  return target == site.cell || is_passed || (is_below && site.is_standing);
}

bool Stages::is_whole(std::uint32_t confirmed_count) const {
  std::uint32_t named_count = 0;
  for (int i = 0; i < total_; ++i) {
    const StepWord& mine = word(i);
    named_count += mine.kind == Kind::kAttach ? 0 : 1;
    const StepWord* mover = mover_of(mine.group);
    if (mine.kind == Kind::kMove && (mine.first != mover->first || mine.second != mover->second)) {
      return false;
    }
  }
  for (std::uint8_t group = 0; group < kGroupCount; ++group) {
    const StepWord* mover = mover_of(group);
    for (int waypoint = 0; mover != nullptr && waypoint < waypoint_count(*mover); ++waypoint) {
      if (carrier_count(group, waypoint) == 0) {
        return false;
      }
    }
  }
  return !is_disputed_ && confirmed_count == named_count && scene_count(Stage::kShift) <= kSceneMax;
}

const StepWord* Stages::find(Kind kind, const Cell& cell) const {
  for (int i = 0; i < total_; ++i) {
    if (word(i).kind == kind && word(i).cell == cell) {
      return &word(i);
    }
  }
  return nullptr;
}

// ---- The stage that is judged.

void Stages::enter(Stage stage, std::uint8_t scene) {
  if (stage == Stage::kRelease && scene == 0) {
    answers_ = {};
  }
  stage_ = stage;
  scene_ = scene;
}

void Stages::note(Stage stage, const Answer& answer) {
  Answer& worst = answers_[at(stage)];
  if (scene_ == 0) {
    worst = answer;
    return;
  }
  const bool has_ratio = answer.verdict == Verdict::kSafe || answer.verdict == Verdict::kOverload;
  if (has_ratio && answer.load_ratio_max > worst.load_ratio_max) {
    worst.worst_cell = answer.worst_cell;
    worst.worst_direction = answer.worst_direction;
    worst.load_ratio_max = answer.load_ratio_max;
  }
  if (severity(answer.verdict) > severity(worst.verdict)) {
    worst.verdict = answer.verdict;
    worst.reason = answer.reason;
  }
}

Stage Stages::failing() const {
  Stage undecided = Stage::kNone;
  for (const Stage stage : {Stage::kRelease, Stage::kShift, Stage::kConnect}) {
    const int bad = severity(answer(stage).verdict);
    if (bad > 1) {
      return stage;
    }
    undecided = bad == 1 && undecided == Stage::kNone ? stage : undecided;
  }
  return undecided;
}

Answer Stages::overall() const {
  const Stage bad = failing();
  if (bad != Stage::kNone) {
    return answer(bad);
  }
  Answer worst = answer(Stage::kRelease);
  for (const Stage stage : {Stage::kShift, Stage::kConnect}) {
    worst = answer(stage).load_ratio_max > worst.load_ratio_max ? answer(stage) : worst;
  }
  return worst;
}

// ---- What the stage makes of the module in a cell.

bool Stages::is_target(const Cell& cell) const {
  for (int i = 0; i < total_; ++i) {
    const StepWord& mine = word(i);
    if ((mine.kind == Kind::kMove && target_of(mine) == cell) ||
        (mine.kind == Kind::kAttach && mine.cell == cell)) {
      return true;
    }
  }
  return false;
}

/// The word by which the module of a cell is gone in this stage. Where another one comes to its
/// place nothing is changed by that in the end: all modules are alike.
const StepWord* Stages::leaving(const Cell& cell) const {
  if (stage_ != Stage::kShift && stage_ != Stage::kConnect) {
    return nullptr;
  }
  const StepWord* word = find(Kind::kMove, cell);
  word = word == nullptr ? find(Kind::kDetach, cell) : word;
  const bool is_refilled = stage_ == Stage::kConnect && word != nullptr && is_target(cell);
  return is_refilled ? nullptr : word;
}

/// A module that is to move lets go of all but its group and the carriers of that.
bool Stages::lets_go(const Cell& from, const Cell& other) const {
  const StepWord* mover = find(Kind::kMove, from);
  if (mover == nullptr) {
    return false;
  }
  for (int i = 0; i < total_; ++i) {
    const StepWord& kept = word(i);
    const bool is_kind = kept.kind == Kind::kMove || kept.kind == Kind::kCarry;
    if (is_kind && kept.group == mover->group && kept.cell == other) {
      return false;
    }
  }
  return true;
}

bool Stages::is_off(const Cell& cell, Direction face) const {
  const Cell other = base::neighbour(cell, face);
  const auto there = static_cast<std::uint8_t>(base::opposite(face));
  const StepWord* mine = leaving(cell);
  const StepWord* theirs = leaving(other);
  if (mine != nullptr || theirs != nullptr) {
    const bool is_kept = (mine != nullptr && mine->face == static_cast<std::uint8_t>(face)) ||
                         (theirs != nullptr && theirs->face == there);
    return !is_kept;
  }
  for (int i = 0; i < total_; ++i) {
    const StepWord& off = word(i);
    const bool is_here = off.cell == cell && off.face == static_cast<std::uint8_t>(face);
    const bool is_there = off.cell == other && off.face == there;
    if (off.kind == Kind::kOff && (is_here || is_there) &&
        (off.mask & bit(static_cast<int>(stage_) - 1)) != 0) {
      return true;
    }
  }
  return stage_ == Stage::kRelease && (lets_go(cell, other) || lets_go(other, cell));
}

Faces Stages::hidden(const Cell& cell) const {
  Faces faces;
  for (const Direction face : base::kDirections) {
    faces.set(face, stage() != Stage::kNone && is_off(cell, face));
  }
  return faces;
}

bool Stages::find_planned(bool has_last, const Cell& last, Cell& cell) const {
  bool is_found = false;
  for (int i = 0; i < total_ && stage() == Stage::kConnect; ++i) {
    const StepWord& mine = word(i);
    const Cell there = mine.kind == Kind::kMove ? target_of(mine) : mine.cell;
    const bool comes = mine.kind == Kind::kMove || mine.kind == Kind::kAttach;
    const bool is_refilled =
        find(Kind::kMove, there) != nullptr || find(Kind::kDetach, there) != nullptr;
    if (comes && !is_refilled && (!has_last || there > last) && (!is_found || there < cell)) {
      cell = there;
      is_found = true;
    }
  }
  return is_found;
}

const StepWord* Stages::mover_of(std::uint8_t group) const {
  for (int i = 0; i < total_; ++i) {
    if (word(i).kind == Kind::kMove && word(i).group == group) {
      return &word(i);
    }
  }
  return nullptr;
}

/// The carrier word of a group at a waypoint, or at its last one if it has arrived; null behind the
/// last choice.
const StepWord* Stages::carrier(std::uint8_t group, int waypoint, int choice) const {
  const StepWord* mover = mover_of(group);
  const int last = waypoint_count(*mover) - 1;
  const std::uint8_t here = bit(waypoint < last ? waypoint : last);
  for (int i = 0; i < total_; ++i) {
    const StepWord& mine = word(i);
    if (mine.kind == Kind::kCarry && mine.group == group && (mine.mask & here) != 0 &&
        choice-- == 0) {
      return &mine;
    }
  }
  return nullptr;
}

int Stages::carrier_count(std::uint8_t group, int waypoint) const {
  int count = 0;
  while (carrier(group, waypoint, count) != nullptr) {
    ++count;
  }
  return count;
}

int Stages::scene_count(Stage stage) const {
  if (stage != Stage::kShift) {
    return 1;
  }
  int waypoints = 1;
  for (std::uint8_t group = 0; group < kGroupCount; ++group) {
    const StepWord* mover = mover_of(group);
    const int mine = mover == nullptr ? 1 : waypoint_count(*mover);
    waypoints = mine > waypoints ? mine : waypoints;
  }
  int count = 0;
  for (int waypoint = 0; waypoint < waypoints; ++waypoint) {
    int here = 1;
    for (std::uint8_t group = 0; group < kGroupCount; ++group) {
      here *= mover_of(group) == nullptr ? 1 : carrier_count(group, waypoint);
    }
    count += here;
  }
  return count;
}

/// Which waypoint and which carriers the scene is of.
bool Stages::find_scene(int& waypoint, Choice& choice) const {
  int rest = scene_;
  for (waypoint = 0; waypoint < kWaypointMax; ++waypoint) {
    int here = 1;
    for (std::uint8_t group = 0; group < kGroupCount; ++group) {
      here *= mover_of(group) == nullptr ? 1 : carrier_count(group, waypoint);
    }
    if (rest >= here) {
      rest -= here;
      continue;
    }
    for (std::uint8_t group = 0; group < kGroupCount; ++group) {
      const int count = mover_of(group) == nullptr ? 1 : carrier_count(group, waypoint);
      choice[group] = static_cast<std::uint8_t>(rest % count);
      rest /= count;
    }
    return true;
  }
  return false;
}

/// Does the module in `cell` carry the group in this scene? Then `waypoint` is where.
bool Stages::carries(std::uint8_t group, const Cell& cell, int& waypoint) const {
  Choice choice{};
  return stage() == Stage::kShift && mover_of(group) != nullptr && find_scene(waypoint, choice) &&
         carrier(group, waypoint, choice[group])->cell == cell;
}

StageMass Stages::mass(const Cell& cell) const {
  StageMass sum{.mass = is_gone(cell) ? 0 : 2};
  for (std::uint8_t group = 0; group < kGroupCount; ++group) {
    int waypoint = 0;
    if (!carries(group, cell, waypoint)) {
      continue;
    }
    for (int i = 0; i < total_; ++i) {
      if (word(i).kind == Kind::kMove && word(i).group == group) {
        const auto place = doubled_place(word(i), waypoint, cell);
        sum.mass += 2;
        for (std::size_t k = 0; k < 3; ++k) {
          sum.moment[k] += place[k];
        }
      }
    }
  }
  return sum;
}

void Stages::hang(const Cell& cell, const Setup& setup) {
  const StageMass sum = mass(cell);
  const double half_pitch = setup.section.length / 2;
  hung_ = {};
  hung_[2] = -setup.weight_n * (sum.mass - 2) / 2;
  hung_[3] = -setup.weight_n * half_pitch * sum.moment[1];
  hung_[4] = setup.weight_n * half_pitch * sum.moment[0];
}

/// The load of the group about the middle of the carrier's facet: tension along the facet's
/// direction, and bending about the two axes across it.
bool Stages::find_hanging(std::uint8_t group, const Cell& cell, const Setup& setup,
                          Direction& direction, double& ratio) const {
  int waypoint = 0;
  if (!carries(group, cell, waypoint)) {
    return false;
  }
  std::int32_t nearest = 0x7fffffff;
  std::int32_t count = 0;
  std::array<std::int32_t, 3> sum{};
  for (int i = 0; i < total_; ++i) {
    if (word(i).kind != Kind::kMove || word(i).group != group) {
      continue;
    }
    const auto place = doubled_place(word(i), waypoint, cell);
    ++count;
    for (std::size_t k = 0; k < 3; ++k) {
      sum[k] += place[k];
    }
    for (const Direction face : base::kDirections) {
      const std::int32_t apart = square_between(place, doubled_unit(face));
      nearest = apart < nearest ? apart : nearest;
    }
  }
  const double half_pitch = setup.section.length / 2;
  bool is_found = false;
  for (int i = 0; i < total_; ++i) {
    for (const Direction face : base::kDirections) {
      if (word(i).kind != Kind::kMove || word(i).group != group ||
          square_between(doubled_place(word(i), waypoint, cell), doubled_unit(face)) != nearest) {
        continue;
      }
      // Arms count from the middle of the facet, half a pitch from the node.
      const auto unit = doubled_unit(face);
      const double x = half_pitch * (sum[0] - count * unit[0] / 2);
      const double y = half_pitch * (sum[1] - count * unit[1] / 2);
      const std::array<double, 3> torque = {-y * setup.weight_n, x * setup.weight_n, 0};
      const auto axis = static_cast<std::size_t>(base::index(face)) / 2;
      const base::Vec6<double> middle = {0,
                                         0,
                                         -setup.weight_n * count * unit[2] / 2,
                                         torque[(axis + 1) % 3],
                                         torque[(axis + 2) % 3],
                                         0};
      const double strength =
          base::is_vertical(face) ? setup.strength_vertical_n : setup.strength_lateral_n;
      const double here =
          mechanics::load_ratio(mechanics::connection_load(middle), setup.facet_mm, strength);
      if (!is_found || here > ratio) {
        direction = face;
        ratio = here;
      }
      is_found = true;
    }
  }
  return is_found;
}

}  // namespace holdfast::agent
