// Compiled expressions: one list of operations over registers, evaluated over any number type (double, complex, dual,
// Taylor). Nothing of the text is ever executed.
#pragma once

namespace tunewright {

class Program;

}  // namespace tunewright
