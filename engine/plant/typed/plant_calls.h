// The functions with which control software builds a plant, from a call to a formula or a state space.
#pragma once

#include <string_view>

#include "engine/plant/typed/call.h"
#include "engine/plant/typed/formula.h"

namespace tunewright::typed {

/// True for the name, in lower case, of a function that gives a formula: tf, zpk and their names in Python, delay of
/// Julia, and the blocks TransferFunction, FirstOrder, SecondOrder, Integrator, Gain and FixedDelay of Modelica.
bool is_formula_function(std::string_view name);
/// True for ss and its synonyms.
bool is_state_space_function(std::string_view name);

/// The formula of a call; a delay may be an argument: 'InputDelay', 'OutputDelay', 'IODelay'. Faults at the cursor: an
/// unknown argument, a sample time other than 0, lists that are empty or belong to several inputs or outputs.
Formula formula_of_call(const Call& call, Cursor& cursor);
StateSpace state_space_of_call(const Call& call, Cursor& cursor);

/// A fault at the call of any other function, with the reason if it is known from control software.
void refuse_call(const Word& name, Cursor& cursor);

}  // namespace tunewright::typed
