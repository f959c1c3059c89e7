// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <exception>
#include <iostream>

#include "holdfast_code.hpp"
#include "robots/blinkyBlocks/blinkyBlocksSimulator.h"

int main(int argc, char** argv) {
  using holdfast::visiblesim::HoldfastCode;
  try {
    BlinkyBlocks::createSimulator(argc, argv, HoldfastCode::build);
    const int exit_code = holdfast::visiblesim::Session::instance().exit_code();
    BaseSimulator::deleteSimulator();
    return exit_code;
  } catch (const std::exception& error) {
    std::cerr << "holdfast: " << error.what() << std::endl;
  }
  return 2;
}
