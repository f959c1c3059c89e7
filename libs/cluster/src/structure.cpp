// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "structure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include "binary_file.hpp"
#include "holdfast/base/algebra.hpp"
#include "holdfast/holdfast.hpp"
#include "morton_split.hpp"
#include "shared_text.hpp"

namespace holdfast::cluster {
namespace {

using base::at;

base::Error bad_input(std::string message, std::string where = {}) {
  return {
      .code = base::ErrorCode::kBadInput, .message = std::move(message), .where = std::move(where)};
}

/// Modules that have something of their own, by their place in the document.
std::set<std::pair<std::size_t, std::size_t>> special_modules(const io::Document& document) {
  std::set<std::pair<std::size_t, std::size_t>> special;
  for (const io::OwnParameters& own : document.extension.own) {
    special.emplace(own.step, own.module);
  }
  return special;
}

/// The document without its modules but those that have something of their own, and the first.
io::Document without_modules(const io::Document& document) {
  io::Document common;
  common.name = document.name;
  common.support_z = document.support_z;
  common.material = document.material;
  common.extension = document.extension;
  common.extension.own.clear();
  common.extension.plan.clear();
  const auto special = special_modules(document);
  for (std::size_t i = 0; i < document.modules.size(); ++i) {
    if (i == 0 || special.contains({0, i})) {
      common.modules.emplace_back().cell = document.modules[i].cell;
    }
  }
  for (const io::OwnParameters& own : document.extension.own) {
    const bool is_planned = own.step == 1;
    if (own.step > 1) {
      continue;
    }
    const base::Cell& cell =
        is_planned ? document.steps.front()[own.module].cell : document.modules[own.module].cell;
    auto found = std::ranges::find(common.modules, cell, &io::ModuleEntry::cell);
    if (found == common.modules.end()) {
      common.modules.emplace_back().cell = cell;
      found = common.modules.end() - 1;
    }
    io::OwnParameters moved = own;
    moved.step = 0;
    moved.module = static_cast<std::size_t>(found - common.modules.begin());
    common.extension.own.push_back(std::move(moved));
  }
  std::ranges::sort(common.extension.own, {}, &io::OwnParameters::module);
  return common;
}

std::vector<Record> records_of(const io::Document& document) {
  std::vector<Record> records;
  records.reserve(document.modules.size());
  for (const io::ModuleEntry& module : document.modules) {
    const auto& [x, y, z] = module.cell;
    records.push_back({.cell = {x, y, z}, .flags = module.is_fixed ? Record::kFixed : 0});
  }
  if (!document.steps.empty()) {
    for (const io::PlannedEntry& planned : document.steps.front()) {
      const auto& [x, y, z] = planned.cell;
      records.push_back({.cell = {x, y, z}, .flags = Record::kPlanned});
    }
  }
  return records;
}

base::Cell low_corner(const base::Lattice& lattice, const std::vector<Record>& records) {
  constexpr std::int32_t kMax = std::numeric_limits<std::int32_t>::max();
  base::Cell low = {kMax, kMax, kMax};
  const solver::Bricks bricks(lattice);
  for (const Record& record : records) {
    const base::Cell brick = bricks.of(record.place());
    low = {std::min(low.x, brick.x), std::min(low.y, brick.y), std::min(low.z, brick.z)};
  }
  return low;
}

/// Sorts modules along the curve; returns their keys. Error: two in one cell.
base::Result<std::vector<std::uint64_t>> sort_along_curve(const base::Lattice& lattice,
                                                          const base::Cell& low,
                                                          std::vector<Record>& records) {
  const solver::Bricks bricks(lattice);
  std::vector<std::pair<std::uint64_t, Record>> keyed;
  keyed.reserve(records.size());
  for (const Record& record : records) {
    keyed.emplace_back(solver::morton_key(bricks.of(record.place()), low), record);
  }
  std::ranges::sort(keyed, {}, [](const auto& one) { return one.first; });
  std::vector<std::uint64_t> keys;
  for (std::size_t i = 0; i < keyed.size(); ++i) {
    if (!keys.empty() && keys.back() == keyed[i].first) {
      return bad_input(fmt::format("two modules in the cell {}, allowed is one",
                                   model::text(keyed[i].second.place())));
    }
    keys.push_back(keyed[i].first);
    records[i] = keyed[i].second;
  }
  return keys;
}

/// What the first rank has read, before it is handed out.
struct Whole {
  SharedText text;  ///< What all ranks are to know.
  std::vector<Record> records;
  std::vector<std::uint64_t> keys;
};

base::Result<Whole> read_whole(const std::string& file, const io::ReadOptions& options) {
  const auto text = read_file(file);
  if (!text) {
    return text.error();
  }
  auto read = io::read_document(text.value(), options);
  if (!read) {
    return read.error();
  }
  const auto& [document, warnings] = read.value();
  if (auto spec = io::make_spec(document); !spec) {
    return spec.error();
  }
  Whole whole;
  whole.records = records_of(document);
  whole.text.low = low_corner(document.extension.lattice, whole.records);
  auto keys = sort_along_curve(document.extension.lattice, whole.text.low, whole.records);
  if (!keys) {
    return keys.error();
  }
  whole.keys = std::move(keys).value();
  whole.text.document = common_text(document);
  whole.text.warnings = warnings;
  return whole;
}

/// Hands each rank its range of modules.
std::vector<Record> scatter(PetscRanks& ranks, const Whole& whole) {
  std::vector<std::vector<std::byte>> parts(at(ranks.count()));
  if (ranks.rank() == 0) {
    const auto key = [&](std::size_t i) { return whole.keys[i]; };
    for (std::size_t rank = 0; rank < parts.size(); ++rank) {
      const std::size_t begin = split_point(whole.keys.size(), parts.size(), rank, key);
      const std::size_t end = split_point(whole.keys.size(), parts.size(), rank + 1, key);
      const auto bytes = std::as_bytes(std::span(whole.records).subspan(begin, end - begin));
      parts[rank].assign(bytes.begin(), bytes.end());
    }
  }
  const std::vector<std::byte> mine = ranks.exchange(parts).front();
  std::vector<Record> records(mine.size() / sizeof(Record));
  if (!records.empty()) {
    std::memcpy(records.data(), mine.data(), mine.size());
  }
  return records;
}

base::Result<Structure> structure_of(PetscRanks& ranks, const SharedText& text,
                                     std::vector<Record> records) {
  auto read = io::read_json(text.document);
  if (!read) {
    return read.error();
  }
  auto spec = io::make_spec(read.value().document);
  if (!spec) {
    return spec.error();
  }
  Structure structure{.name = read.value().document.name,
                      .common = std::move(spec).value(),
                      .records = std::move(records),
                      .low = text.low,
                      .warnings = text.warnings};
  structure.common.existing.clear();
  structure.common.fixed.clear();
  const std::size_t first = host::starts(ranks, structure.records.size())[at(ranks.rank())];
  structure.fingerprint =
      text_sum(text.document) ^ sum_of_ranks(ranks, record_sum(structure.records, first));
  return structure;
}

base::Result<Structure> read_text(PetscRanks& ranks, const std::string& file,
                                  const io::ReadOptions& options) {
  Whole whole;
  std::optional<base::Error> error;
  if (ranks.rank() == 0) {
    auto read = read_whole(file, options);
    if (read) {
      whole = std::move(read).value();
    } else {
      error = read.error();
    }
    if (error) {
      whole.text.error = *error;
      whole.text.is_error = true;
    }
  }
  whole.text = shared_by_first(ranks, whole.text);
  if (whole.text.is_error) {
    return whole.text.error;
  }
  return structure_of(ranks, whole.text, scatter(ranks, whole));
}

}  // namespace

base::Result<Structure> read_structure(PetscRanks& ranks, const std::string& file,
                                       const io::ReadOptions& options) {
  if (!is_binary_file(ranks, file)) {
    return read_text(ranks, file, options);
  }
  auto read = read_binary_file(ranks, file);
  if (!read) {
    return read.error();
  }
  auto [text, records] = std::move(read).value();
  return structure_of(ranks, text, std::move(records));
}

std::string common_text(const io::Document& document) {
  return io::write_json(without_modules(document));
}

base::Result<std::size_t> write_binary(const io::Document& document, const std::string& file) {
  if (auto spec = io::make_spec(document); !spec) {
    return spec.error();
  }
  std::vector<Record> records = records_of(document);
  const base::Cell low = low_corner(document.extension.lattice, records);
  auto keys = sort_along_curve(document.extension.lattice, low, records);
  if (!keys) {
    return keys.error();
  }
  if (auto error = write_binary_file(file, low, common_text(document), records)) {
    return *error;
  }
  return records.size();
}

}  // namespace holdfast::cluster
