// Several statements that define a plant, as they stand in a program of control software.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "engine/expected.h"
#include "engine/plant/typed/formula.h"
#include "engine/plant/typed/lists.h"
#include "engine/plant/typed/words.h"

namespace tunewright::typed {

/// The words of one statement; the last is of kind `end`.
using Statement = std::vector<Word>;

/// The statements of a text. They end at ";" outside brackets, and at a line break where the statement before it or
/// after it is one of a program. The first lines of programs (import, using, pkg load) are left out.
std::vector<Statement> statements_of(const std::vector<Word>& words);

/// The statement without "G =" or "P(s) =" before its value.
Statement value_of(const Statement& statement);

/// True if the statements assign names that are not parameters of a plant, so that K=2 is a statement too.
bool is_program(const std::vector<Statement>& statements);

/// The plant of the last statement:
///
///   statement:  name "=" value | name "." InputDelay "=" number | value | block | connect(a.y, b.u)
///   value:      formula | list | ss(A, B, C, D) times numbers and dead times
///   block:      class name "(" arguments ")", a declaration of Modelica
///
/// Blocks are joined by connect(), in series. Values of earlier statements may be used by their names.
Expected<std::variant<Formula, StateSpace>> read_program(const std::vector<Statement>& statements, double own_time);

/// The values that the statements assign.
Expected<Names> read_names(const std::vector<Statement>& statements, double own_time);

}  // namespace tunewright::typed
