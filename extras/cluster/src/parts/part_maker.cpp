// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "parts/part_maker.hpp"

#include <algorithm>
#include <cstring>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>

#include "holdfast/base/algebra.hpp"
#include "holdfast/base/lattice.hpp"
#include "holdfast/solver/morton_key.hpp"
#include "holdfast/solver/passages.hpp"
#include "parts/wholeness.hpp"

namespace holdfast::cluster {
namespace {

using base::at;

template <class Item>
std::vector<std::byte> bytes_of(const std::vector<Item>& items) {
  std::vector<std::byte> bytes(items.size() * sizeof(Item));
  if (!items.empty()) {
    std::memcpy(bytes.data(), items.data(), bytes.size());
  }
  return bytes;
}

template <class Item>
std::vector<Item> items_of(const std::vector<std::byte>& bytes) {
  std::vector<Item> items(bytes.size() / sizeof(Item));
  if (!items.empty()) {
    std::memcpy(items.data(), bytes.data(), bytes.size());
  }
  return items;
}

/// A rank's answer about a cell that another one has asked for.
struct Answer {
  std::int32_t index = -1;  ///< Among its own modules; -1: there is none.
  std::uint32_t flags = 0;
};

/// Finds the modules of other ranks that are neighbours of this rank's own.
class Neighbourhood {
 public:
  Neighbourhood(PetscRanks& ranks, const Structure& structure)
      : ranks_(ranks),
        structure_(structure),
        lattice_(structure.common.lattice),
        bricks_(lattice_) {
    keys_.reserve(structure.records.size());
    for (const Record& record : structure.records) {
      keys_.push_back(key_of(record.place()));
    }
    first_ = host::gather(ranks, std::span<const std::uint64_t>(keys_.data(), 1));
    const auto here = at(ranks.rank());
    first_here_ = here == 0 ? 0 : first_[here];
    last_here_ = here + 1 == first_.size() ? std::numeric_limits<std::uint64_t>::max()
                                           : first_[here + 1] - 1;
  }

  /// Copies of all neighbours; appends their records to those of the rank's own.
  std::vector<host::Copy> find(std::vector<Record>& records) {
    const std::vector<std::vector<base::Cell>> asked = ask();
    std::vector<std::vector<std::byte>> questions;
    for (const std::vector<base::Cell>& cells : asked) {
      questions.push_back(bytes_of(cells));
    }
    std::vector<std::vector<std::byte>> answers;
    for (const std::vector<std::byte>& question : ranks_.exchange(questions)) {
      answers.push_back(bytes_of(answer(items_of<base::Cell>(question))));
    }
    answers = ranks_.exchange(answers);
    std::vector<host::Copy> copies;
    for (std::size_t rank = 0; rank < asked.size(); ++rank) {
      const auto answer = items_of<Answer>(answers[rank]);
      for (std::size_t i = 0; i < answer.size(); ++i) {
        if (answer[i].index >= 0) {
          const base::Cell& cell = asked[rank][i];
          copies.push_back({.original = {static_cast<std::int32_t>(rank), answer[i].index},
                            .place = static_cast<std::int32_t>(records.size())});
          records.push_back({.cell = {cell.x, cell.y, cell.z}, .flags = answer[i].flags});
        }
      }
    }
    first_records_ = records;
    return copies;
  }

  /// Copies of what straight runs that begin here go on to, as far as their other ends. `robot` is
  /// this rank's part, and `axes` are its modules' passage_axes().
  std::vector<host::Copy> follow_runs(const model::Robot& robot,
                                      const std::vector<std::int8_t>& axes,
                                      std::vector<Record>& records) {
    const std::vector<host::Copy>& copies = robot.part().copies;
    std::vector<host::Copy> all = copies;
    std::set<base::Cell> known;
    std::vector<Foremost> foremost;
    for (std::size_t i = 0; i < copies.size(); ++i) {
      const auto place = at(copies[i].place);
      known.insert(records[place].place());
      for (const int side : {0, 1}) {
        if (axes[place] >= 0 &&
            robot.connected()[place][at(2 * axes[place] + side)] == model::Robot::kNoNeighbour) {
          foremost.push_back({.copy = i, .direction = 2 * axes[place] + side});
        }
      }
    }
    while (host::any(ranks_, !foremost.empty())) {
      foremost = step(robot, copies, axes, foremost, known, all, records);
    }
    return all;
  }

 private:
  /// A copy where a run goes on in a direction to a module that is not known here yet.
  struct Foremost {
    std::size_t copy = 0;
    int direction = 0;
  };

  struct Question {
    std::int32_t module = 0;  ///< Of the rank that is asked.
    std::int32_t direction = 0;
  };

  /// The module beside the one that a question asks about.
  struct Beside {
    host::Original original;
    Record record;
    std::int32_t axis = -1;  ///< If it passes forces on.
  };

  std::vector<Foremost> step(const model::Robot& robot, const std::vector<host::Copy>& copies,
                             const std::vector<std::int8_t>& axes,
                             const std::vector<Foremost>& foremost, std::set<base::Cell>& known,
                             std::vector<host::Copy>& all, std::vector<Record>& records) {
    std::vector<std::vector<Question>> asked(at(ranks_.count()));
    for (const Foremost& one : foremost) {
      const host::Original& original = all[one.copy].original;
      asked[at(original.rank)].push_back({original.index, one.direction});
    }
    std::vector<std::vector<std::byte>> questions;
    for (const std::vector<Question>& list : asked) {
      questions.push_back(bytes_of(list));
    }
    std::vector<std::vector<std::byte>> answers;
    for (const std::vector<std::byte>& list : ranks_.exchange(questions)) {
      std::vector<Beside> beside;
      for (const Question& question : items_of<Question>(list)) {
        const auto next = at(robot.connected()[at(question.module)][at(question.direction)]);
        const bool is_own = next < structure_.records.size();
        beside.push_back(
            {.original = is_own ? host::Original{ranks_.rank(), static_cast<std::int32_t>(next)}
                                : copies[next - structure_.records.size()].original,
             .record = first_records_[next],
             .axis = axes[next]});
      }
      answers.push_back(bytes_of(beside));
    }
    answers = ranks_.exchange(answers);
    std::vector<Foremost> later;
    for (std::size_t rank = 0; rank < asked.size(); ++rank) {
      const auto beside = items_of<Beside>(answers[rank]);
      for (std::size_t i = 0; i < beside.size(); ++i) {
        const Beside& one = beside[i];
        const bool is_here =
            one.original.rank == ranks_.rank() || !known.insert(one.record.place()).second;
        if (is_here) {
          continue;
        }
        if (one.axis == asked[rank][i].direction / 2) {
          later.push_back({.copy = all.size(), .direction = asked[rank][i].direction});
        }
        all.push_back(
            {.original = one.original, .place = static_cast<std::int32_t>(records.size())});
        records.push_back(one.record);
      }
    }
    return later;
  }

  std::uint64_t key_of(const base::Cell& cell) const {
    return solver::morton_key(bricks_.of(cell), structure_.low);
  }

  /// Whether a cell may hold a module: keys begin at the lowest corner.
  bool is_possible(const base::Cell& cell) const {
    const base::Cell brick = bricks_.of(cell);
    return brick.x >= structure_.low.x && brick.y >= structure_.low.y &&
           brick.z >= structure_.low.z;
  }

  /// Whether a key lies in this rank's range.
  bool is_here(std::uint64_t key) const { return key >= first_here_ && key <= last_here_; }

  /// Whether all neighbours of a module are surely in this rank's range: keys rise with each
  /// coordinate, of which theirs are one less or more at most in any lattice.
  bool is_inside(const base::Cell& cell) const {
    const base::Cell brick = bricks_.of(cell);
    const base::Cell& low = structure_.low;
    const base::Cell before = {std::max(brick.x - 1, low.x), std::max(brick.y - 1, low.y),
                               std::max(brick.z - 1, low.z)};
    return is_here(solver::morton_key(before, low)) &&
           is_here(solver::morton_key({brick.x + 1, brick.y + 1, brick.z + 1}, low));
  }

  /// The rank whose range of keys a key lies in.
  std::size_t owner_of(std::uint64_t key) const {
    const auto after = std::ranges::upper_bound(first_, key);
    return after == first_.begin() ? 0 : static_cast<std::size_t>(after - first_.begin()) - 1;
  }

  /// Cells beside this rank's own modules that are in other ranks' ranges, by rank.
  std::vector<std::vector<base::Cell>> ask() const {
    std::vector<std::vector<base::Cell>> asked(at(ranks_.count()));
    const auto here = at(ranks_.rank());
    for (const Record& record : structure_.records) {
      if (is_inside(record.place())) {
        continue;
      }
      for (const base::Direction direction : base::directions(lattice_)) {
        const base::Cell cell = base::neighbour(lattice_, record.place(), direction);
        const std::size_t owner = is_possible(cell) ? owner_of(key_of(cell)) : here;
        if (owner != here) {
          asked[owner].push_back(cell);
        }
      }
    }
    for (std::vector<base::Cell>& cells : asked) {
      std::ranges::sort(cells);
      cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
    }
    return asked;
  }

  std::vector<Answer> answer(const std::vector<base::Cell>& cells) const {
    std::vector<Answer> answers;
    for (const base::Cell& cell : cells) {
      const std::uint64_t key = key_of(cell);
      const auto found = std::ranges::lower_bound(keys_, key);
      const bool is_there = found != keys_.end() && *found == key;
      const auto index = found - keys_.begin();
      answers.push_back(
          is_there ? Answer{.index = static_cast<std::int32_t>(index),
                            .flags = structure_.records[static_cast<std::size_t>(index)].flags}
                   : Answer{});
    }
    return answers;
  }

  PetscRanks& ranks_;
  const Structure& structure_;
  const base::Lattice& lattice_;
  const solver::Bricks bricks_;
  std::vector<std::uint64_t> keys_;    ///< Of this rank's modules, ascending.
  std::vector<std::uint64_t> first_;   ///< Of each rank.
  std::uint64_t first_here_ = 0;       ///< This rank's range of keys,
  std::uint64_t last_here_ = 0;        ///< the last one included.
  std::vector<Record> first_records_;  ///< Of own modules and their neighbours.
};

/// Keeps the entries of a list that belong to modules of this rank, copies included.
template <class Entry, class CellOf>
void keep_own(std::vector<Entry>& list, const std::map<base::Cell, bool>& is_own, bool with_copies,
              const CellOf& cell_of) {
  std::erase_if(list, [&](const Entry& entry) {
    const auto found = is_own.find(cell_of(entry));
    return found == is_own.end() || (!with_copies && !found->second);
  });
}

/// Removes from a spec what is said of modules that this rank does not have.
void restrict(const std::vector<Record>& records, std::size_t own_count, model::RobotSpec& spec) {
  if (spec.own_kinds.empty() && spec.own_masses.empty() && spec.payloads.empty() &&
      spec.carried.empty() && spec.released.empty() && spec.own_connectors.empty()) {
    return;
  }
  std::map<base::Cell, bool> is_own;
  for (std::size_t i = 0; i < records.size(); ++i) {
    is_own.emplace(records[i].place(), i < own_count);
  }
  const auto cell = [](const auto& entry) { return entry.cell; };
  keep_own(spec.own_kinds, is_own, true, cell);
  keep_own(spec.own_masses, is_own, true, cell);
  keep_own(spec.payloads, is_own, true, cell);
  keep_own(spec.carried, is_own, false, [](const auto& entry) { return entry.carrier; });
  const auto is_foreign = [&](const model::CellPair& pair) {
    return !is_own.contains(pair[0]) || !is_own.contains(pair[1]);
  };
  std::erase_if(spec.released, is_foreign);
  std::erase_if(spec.own_connectors,
                [&](const model::OwnConnector& own) { return is_foreign(own.between); });
}

/// The first fault that any rank has found.
std::optional<std::string> first_fault(PetscRanks& ranks, const std::optional<std::string>& mine) {
  const std::string text = mine.value_or("");
  const auto bytes = ranks.gather(std::as_bytes(std::span(text.data(), text.size())));
  if (bytes.empty()) {
    return std::nullopt;
  }
  // Ranks find the same fault at two places, or different ones; any one will do.
  const int first = static_cast<int>(-ranks.max(mine ? -ranks.rank() : -ranks.count()));
  std::size_t begin = 0;
  const auto starts = host::starts(ranks, text.size());
  begin = starts[at(first)];
  std::string found(starts[at(first) + 1] - begin, ' ');
  std::memcpy(found.data(), bytes.data() + begin, found.size());
  return found;
}

ModuleCounts count_modules(PetscRanks& ranks, const Structure& structure,
                           const model::Robot& robot) {
  const auto count = [&](std::uint32_t flag) {
    return host::total(
        ranks,
        static_cast<std::size_t>(std::ranges::count_if(
            structure.records, [&](const Record& record) { return (record.flags & flag) != 0; })));
  };
  return {.all = host::total(ranks, structure.records.size()),
          .planned = count(Record::kPlanned),
          .fixed = count(Record::kFixed),
          .facets = host::total(ranks, robot.facets().size())};
}

/// The robot of own modules and copies.
base::Result<model::Robot> robot_of(PetscRanks& ranks, const Structure& structure,
                                    const std::vector<Record>& records,
                                    const std::vector<host::Copy>& copies) {
  const std::size_t own_count = structure.records.size();
  model::RobotSpec spec = structure.common;
  for (const Record& record : records) {
    spec.existing.push_back(record.place());
    if ((record.flags & Record::kFixed) != 0) {
      spec.fixed.push_back(record.place());
    }
  }
  restrict(records, own_count, spec);
  auto robot =
      model::Robot::create_part(spec, {.ranks = ranks, .own_count = own_count, .copies = copies});
  if (auto fault =
          first_fault(ranks, robot ? std::nullopt : std::optional(robot.error().message))) {
    return base::bad_input(*fault);
  }
  return robot;
}

}  // namespace

base::Result<Part> make_part(PetscRanks& ranks, const Structure& structure) {
  std::vector<Record> records = structure.records;
  Neighbourhood neighbourhood(ranks, structure);
  std::vector<host::Copy> copies = neighbourhood.find(records);
  auto robot = robot_of(ranks, structure, records, copies);
  if (!robot) {
    return robot.error();
  }
  if (auto fault = find_fault(robot.value())) {
    return base::bad_input(*fault);
  }
  const std::vector<std::int8_t> axes = solver::passage_axes(robot.value());
  copies = neighbourhood.follow_runs(robot.value(), axes, records);
  if (host::any(ranks, copies.size() > robot.value().part().copies.size())) {
    robot = robot_of(ranks, structure, records, copies);
    if (!robot) {
      return robot.error();
    }
  }
  const ModuleCounts counts = count_modules(ranks, structure, robot.value());
  return Part{.robot = std::move(robot).value(), .counts = counts};
}

}  // namespace holdfast::cluster
