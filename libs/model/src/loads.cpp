// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/model/loads.hpp"

namespace holdfast::model {

Loads weight_loads(const Material& material) {
  return Loads({0, 0, -module_weight_n(material), 0, 0, 0});
}

}  // namespace holdfast::model
