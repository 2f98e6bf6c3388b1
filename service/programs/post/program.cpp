// SPDX-License-Identifier: Apache-2.0
#include "service/programs/post/program.hpp"

#include "service/programs/post/controls/nc_text.hpp"

namespace meridian::post {

void Program::spindle_off() { block({"M5"}); }

void Program::spindle_on(bool is_clockwise, double rev_per_min) {
  block({"S", fixed(rev_per_min, 0), is_clockwise ? " M3" : " M4"});
}

void Program::coolant(const std::string& word) { block({word}); }

void Program::stop(bool is_optional) { block({is_optional ? "M1" : "M0"}); }

void Program::all_off() {
  spindle_off();
  block({"M9"});
  block({"M30"});
}

}  // namespace meridian::post
