// Reads the call of a function over numbers, lists and words, as MATLAB, Python, Julia and Modelica write it.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "engine/plant/typed/lists.h"
#include "engine/plant/typed/words.h"

namespace tunewright::typed {

struct Argument {
    int position = 1;
    bool is_word = false;  ///< a quoted text, :symbol, or a name that is not a value; else `numbers`
    std::string word = {};
    Matrix numbers = {};
    std::string name = {};  ///< as it is written, if it has one
};

struct Call {
    std::string name;                       ///< as it is written
    int position = 1, end = 1;              ///< of the name and of the closing bracket
    std::vector<Argument> inputs;           ///< by their order
    std::map<std::string, Argument> named;  ///< by names in lower case
};

/// True if the cursor is at a name with a bracket after it.
bool at_call(const Cursor& cursor);

/// The call at the cursor; the cursor is then after its bracket.
///
///   call:      name "(" [ argument { ("," | ";") argument } ] ")"
///   argument:  name "=" value | quoted text "," value | value          value: matrix | quoted text | ":" name | name
///
/// A quoted text with a value after it is the name of that value, as in MATLAB: 'InputDelay', 3. A Modelica
/// declaration has the name of its instance before the bracket: FirstOrder heater(k=2, T=10).
Call read_call(Cursor& cursor, const Names& names);

/// The single real number of an argument; a fault at the cursor if it is something else.
double number_of(const Argument& argument, Cursor& cursor);

}  // namespace tunewright::typed
