// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "picture.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <vector>

#include "holdfast/holdfast.hpp"
#include "holdfast/io/picture.hpp"

namespace holdfast::cluster {
namespace {

namespace fs = std::filesystem;

std::string piece_name(const fs::path& file, int rank) {
  return fmt::format("{}_{}.vtu", file.stem().string(), rank);
}

}  // namespace

std::optional<std::string> find_name_fault(const std::string& file) {
  const fs::path path = file;
  if (path.extension() != ".pvtu") {
    return fmt::format("the name {} does not end in .pvtu", file);
  }
  if (path.filename().string().find_first_of("<>&\"'") != std::string::npos) {
    return fmt::format("the name {} has one of <>&\"'", file);
  }
  return std::nullopt;
}

std::optional<base::Error> write_piece(const std::string& file, const Piece& piece,
                                       const verdict::Assessment& assessment) {
  const fs::path path = file;
  auto error =
      write_file(path.parent_path() / piece_name(path, piece.rank), [&](std::ostream& out) {
        io::write_vtu_piece(out, *piece.robot, piece.own_count, assessment, {.thread_count = 1});
      });
  if (error || piece.rank != 0) {
    return error;
  }
  std::vector<std::string> names;
  for (int rank = 0; rank < piece.rank_count; ++rank) {
    names.push_back(piece_name(path, rank));
  }
  return write_file(
      path, [&](std::ostream& out) { io::write_pvtu(out, *piece.robot, assessment, names); });
}

}  // namespace holdfast::cluster
