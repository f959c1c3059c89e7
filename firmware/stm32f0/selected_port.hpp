// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stm32f0_port.hpp"

namespace holdfast::firmware {

using SelectedPort = stm32f0::Stm32f0Port;

}  // namespace holdfast::firmware
