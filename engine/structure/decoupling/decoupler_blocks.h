// A decoupler over frequency, and as blocks between controllers and plants.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "engine/blocks/block_diagram.h"
#include "engine/structure/decoupling/decoupler.h"

namespace tunewright::structure {

/// No element has a lead, a lag or a delay.
bool has_gains_alone(const Decoupling& elements);

/// On the stack: two or three rows.
using LoopMatrix = Eigen::Matrix<std::complex<double>, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3>;

/// D(s) = (I - E(s))^-1.
LoopMatrix decoupler_response(const Decoupling& elements, std::complex<double> s);

/// Adds the decoupler between the controllers' outputs and the inputs of the plants, of the loops that are `closed`.
void add_decoupler(BlockDiagram& blocks, const Decoupling& elements, unsigned closed, const std::vector<int>& from,
                   const std::vector<int>& to);

}  // namespace tunewright::structure
