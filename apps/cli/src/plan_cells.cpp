// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "plan_cells.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cell_text.hpp"

namespace holdfast::cli {
namespace {

/// A box of more cells than this is taken for a mistake.
constexpr std::int64_t kAvoidedMax = 1'000'000;

/// The box that a text says, of cells that can be listed.
std::optional<plan::CellBox> avoided_box(const std::string& text) {
  const auto box = read_cell_or_box(text);
  if (!box) {
    return box;
  }
  const auto width = [](std::int32_t low, std::int32_t high) {
    return std::int64_t{high} - low + 1;
  };
  const std::int64_t length = width(box->low.x, box->high.x);
  const std::int64_t area = length * std::min(kAvoidedMax + 1, width(box->low.y, box->high.y));
  const bool is_listed = length <= kAvoidedMax && area <= kAvoidedMax &&
                         width(box->low.z, box->high.z) <= kAvoidedMax / area;
  return is_listed ? box : std::nullopt;
}

/// Whether a text that is to be cells or a file can be no file that anybody means.
bool is_mistyped_cell(const std::string& text) {
  return text != "-" && !read_cell_or_box(text) &&
         text.find_first_not_of("0123456789,:-() ") == std::string::npos;
}

}  // namespace

std::vector<std::string> PlanCells::files() const {
  std::vector<std::string> found;
  std::ranges::copy_if(keep, std::back_inserter(found),
                       [](const std::string& text) { return !read_cell_or_box(text); });
  return found;
}

void add_plan_cells(CLI::App& command, PlanCells& cells, const std::string& avoid_help) {
  command.add_option("--avoid", cells.avoid, avoid_help)
      ->type_name("X,Y,Z[:X,Y,Z]")
      ->allow_extra_args(false)
      ->check([](const std::string& text) {
        return avoided_box(text) ? ""
                                 : "expected a cell, such as 3,0,0, or a box by two corners, such "
                                   "as 0,0,1:4,4,1, of at most a million cells";
      });
  command
      .add_option("--keep", cells.keep,
                  "Modules that no step touches: a cell, all in a box of cells, or those of a "
                  "structure in a file; may be given several times")
      ->type_name("X,Y,Z[:X,Y,Z]|FILE")
      ->allow_extra_args(false)
      ->check([](const std::string& text) {
        return is_mistyped_cell(text)
                   ? "expected a cell, such as 3,0,0, a box by two corners, such "
                     "as 0,0,1:4,4,1, or a file"
                   : "";
      });
}

std::vector<base::Cell> avoided_cells(const PlanCells& cells) {
  std::vector<base::Cell> all;
  for (const std::string& text : cells.avoid) {
    const plan::CellBox box = avoided_box(text).value();  // It was checked when it was read.
    for (base::Cell cell = box.low; cell.z <= box.high.z; ++cell.z) {
      for (cell.y = box.low.y; cell.y <= box.high.y; ++cell.y) {
        for (cell.x = box.low.x; cell.x <= box.high.x; ++cell.x) {
          all.push_back(cell);
        }
      }
    }
  }
  return all;
}

base::Result<std::vector<base::Cell>> cells_of_file(const std::string& file, const Reading& reading,
                                                    const model::RobotSpec& robot) {
  const auto read = read_with_notes(file, reading);
  if (!read) {
    return read.error();
  }
  if (io::step_count(read.value().document) > 0) {
    return base::Error{base::ErrorCode::kBadInput,
                       "it has planned modules or steps; expected a robot as it stands",
                       {}};
  }
  const auto spec = io::make_spec(read.value().document);
  if (!spec) {
    return spec.error();
  }
  if (spec.value().lattice != robot.lattice) {
    return base::Error{base::ErrorCode::kBadInput, "its lattice is not that of the target", {}};
  }
  if (const auto other = plan::differences(spec.value(), robot); !other.empty()) {
    print_notes({{fmt::format("only its cells are taken, all else is the target's, which differs "
                              "in {}",
                              fmt::join(other, ", "))}},
                file);
  }
  std::vector<base::Cell> cells;
  for (const io::ModuleEntry& module : read.value().document.modules) {
    cells.push_back(module.cell);
  }
  return cells;
}

bool take_kept(const PlanCells& cells, const Reading& reading, const model::RobotSpec& robot,
               std::vector<plan::CellBox>& kept) {
  for (const std::string& text : cells.keep) {
    if (const auto box = read_cell_or_box(text)) {
      kept.push_back(*box);
      continue;
    }
    const auto listed = cells_of_file(text, reading, robot);
    if (!listed) {
      fail(listed.error(), text);
      return false;
    }
    for (const base::Cell& cell : listed.value()) {
      kept.push_back(plan::box_between(cell, cell));
    }
  }
  return true;
}

}  // namespace holdfast::cli
