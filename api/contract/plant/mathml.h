// The formula of a plant for display.
#pragma once

#include <string>

#include "engine/plant/plant.h"
#include "engine/plant/typed/formula.h"

namespace tunewright::api {

/// P(s) = ... as Presentation MathML without white space, factored as the formula is; numbers with six significant
/// digits. Elements: math, mrow, mfrac, msup, mi, mn, mo; of a state space mtable, mtr, mtd. Only math has attributes.
///
///   mathml(Fopdt{.K = 2, .T = 10, .L = 3})
///     <math xmlns="http://www.w3.org/1998/Math/MathML" display="block"><mrow><mi>P</mi><mrow><mo>(</mo><mi>s</mi>
///     <mo>)</mo></mrow><mo>=</mo><mfrac><mrow><mn>2</mn><msup><mi>e</mi>...
std::string mathml(const typed::Formula& formula);

/// Any linear plant; uncertainty is not shown.
std::string mathml(const Plant& plant);

}  // namespace tunewright::api
