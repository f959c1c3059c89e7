// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <vector>

#include "draw/svg_parts.hpp"
#include "holdfast/io/picture.hpp"

namespace holdfast::io {

std::string write_svg_with_fallen(const model::Robot& robot, std::span<const base::Cell> fallen,
                                  const verdict::Assessment& assessment, std::string_view title,
                                  std::span<const model::Obstacle> obstacles,
                                  const FigureOptions& figure) {
  std::vector<base::Cell> cells(fallen.begin(), fallen.end());
  std::ranges::sort(cells);
  Scene scene(robot, assessment, obstacles, figure);
  scene.has_fallen = !cells.empty();
  for (std::size_t i = 0; i < robot.modules().size(); ++i) {
    if (std::ranges::binary_search(cells, robot.modules()[i].cell)) {
      scene.paints[i] = {.meaning = Meaning::kUnstable};
    }
  }
  return draw_card(scene, title);
}

}  // namespace holdfast::io
