// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stm32f4_port.hpp"

namespace holdfast::firmware {

using SelectedPort = stm32f4::Stm32f4Port;

}  // namespace holdfast::firmware
