// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "parts/structure.hpp"

#include <cstring>
#include <optional>
#include <span>
#include <utility>

#include "holdfast/base/algebra.hpp"
#include "holdfast/holdfast.hpp"
#include "parts/binary_file.hpp"
#include "parts/morton_split.hpp"
#include "ranks/shared_text.hpp"

namespace holdfast::cluster {
namespace {

using base::at;

/// The structure that the first rank has read, before it is handed out.
struct Whole {
  SharedText text;  ///< What all ranks are to know.
  std::vector<Record> records;
  base::Lattice lattice;
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
  auto made = io::make_binary(document);
  if (!made) {
    return made.error();
  }
  io::BinaryStructure structure = std::move(made).value();
  Whole whole;
  whole.records = std::move(structure.records);
  whole.lattice = document.extension.lattice;
  whole.text.low = structure.low;
  whole.text.document = std::move(structure.text);
  whole.text.warnings = warnings;
  return whole;
}

/// Hands each rank its range of modules.
std::vector<Record> scatter(PetscRanks& ranks, const Whole& whole) {
  std::vector<std::vector<std::byte>> parts(at(ranks.count()));
  if (ranks.rank() == 0) {
    const solver::Bricks bricks(whole.lattice);
    const auto key = [&](std::size_t i) {
      return solver::morton_key(bricks.of(whole.records[i].place()), whole.text.low);
    };
    for (std::size_t rank = 0; rank < parts.size(); ++rank) {
      const std::size_t begin = split_point(whole.records.size(), parts.size(), rank, key);
      const std::size_t end = split_point(whole.records.size(), parts.size(), rank + 1, key);
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

/// What is said of single pairs needs modules that ranks do not have.
std::optional<base::Error> find_pairs_fault(const io::Extension& extension) {
  if (extension.open.empty() && extension.connections.empty() && !extension.joins_listed &&
      extension.bodies.empty()) {
    return std::nullopt;
  }
  return base::Error{base::ErrorCode::kUnsupported,
                     "the structure has open faces, connections of its own or bodies, expected "
                     "none: ranks do not know them; check it with holdfast",
                     {}};
}

base::Result<Structure> structure_of(PetscRanks& ranks, const SharedText& text,
                                     std::vector<Record> records,
                                     const io::ReadOptions& options = {}) {
  auto read = io::read_json(text.document, options);
  if (!read) {
    return read.error();
  }
  if (auto error = find_pairs_fault(read.value().document.extension)) {
    return *std::move(error);
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
      io::text_sum(text.document) ^ sum_of_ranks(ranks, io::record_sum(structure.records, first));
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
  auto read = read_binary_file(ranks, file, options);
  if (!read) {
    return read.error();
  }
  auto [text, records] = std::move(read).value();
  return structure_of(ranks, text, std::move(records), options);
}

base::Result<std::size_t> write_binary(const io::Document& document, const std::string& file) {
  const auto structure = io::make_binary(document);
  if (!structure) {
    return structure.error();
  }
  const auto error =
      write_file(file, [&](std::ostream& out) { io::write_binary(out, structure.value()); });
  if (error) {
    return *error;
  }
  return structure.value().records.size();
}

}  // namespace holdfast::cluster
