#include "engine/plant/typed/call.h"

#include <utility>

#include "engine/plant/expression/tokens.h"
#include "engine/plant/typed/plant_calls.h"

namespace tunewright::typed {
namespace {

/// True for a name that is neither a value nor the beginning of a number: true, None, a path of Modelica.
bool is_plain_word(const Cursor& cursor, const Names& names) {
    const Word& word = cursor.now();
    if (word.kind != Word::Kind::name || names.contains(word.text) || at_list(cursor, names)) return false;
    const std::string name = lower(word.text);
    return name != "inf" && word.text != "pi" && name != "i" && name != "j" && name != "im";
}

Argument read_value_of_argument(Cursor& cursor, const Names& names) {
    Argument value{.position = cursor.now().position};
    cursor.skip("*");  // of Python: the elements of a list as arguments
    if (at_call(cursor) && !at_list(cursor, names)) {
        refuse_call(cursor.now(), cursor);
        return value;
    }
    const bool symbol = cursor.at(":") && cursor.peek(1).kind == Word::Kind::name;
    if (symbol) cursor.advance();
    if (symbol || cursor.now().kind == Word::Kind::quoted || is_plain_word(cursor, names)) {
        value.is_word = true;
        value.word = cursor.now().text;
        cursor.advance();
    } else {
        value.numbers = read_matrix(cursor, names);
    }
    return value;
}

void read_argument(Cursor& cursor, const Names& names, Call& call) {
    const Word first = cursor.now();
    const Word& next = cursor.peek(1);
    const bool assigned = first.kind == Word::Kind::name && Cursor::is(next, "=");
    const bool paired = first.kind == Word::Kind::quoted && Cursor::is(next, ",");
    if (!assigned && !paired) return call.inputs.push_back(read_value_of_argument(cursor, names));
    cursor.advance();
    cursor.advance();
    const std::string name = lower(first.text);
    if (call.named.contains(name)) return cursor.fail(first.position, quoted(first.text) + " is given twice.");
    Argument& value = call.named[name] = read_value_of_argument(cursor, names);
    value.name = first.text;
}

}  // namespace

bool at_call(const Cursor& cursor) {
    if (!cursor.at_name()) return false;
    const bool instance = cursor.peek(1).kind == Word::Kind::name;
    return Cursor::is(cursor.peek(instance ? 2 : 1), "(");
}

Call read_call(Cursor& cursor, const Names& names) {
    Call call{.name = cursor.now().text, .position = cursor.now().position, .end = 1, .inputs = {}, .named = {}};
    cursor.advance();
    if (cursor.at_name()) cursor.advance();
    const Word opened = cursor.now();
    cursor.open(opened);
    cursor.advance();
    cursor.skip(";");
    while (!cursor.failed() && !cursor.at(")")) {
        read_argument(cursor, names, call);
        if (!cursor.failed() && !cursor.at(")") && !cursor.skip(",") && !cursor.skip(";"))
            cursor.unexpected("\",\" or \")\"");
    }
    if (cursor.failed()) return call;
    call.end = cursor.now().position;
    cursor.close();
    cursor.advance();
    return call;
}

double number_of(const Argument& argument, Cursor& cursor) {
    const bool single = !argument.is_word && argument.numbers.size() == 1 && argument.numbers[0].size() == 1;
    if (single && argument.numbers[0][0].imag() == 0) return argument.numbers[0][0].real();
    cursor.fail(argument.position, argument.is_word ? quoted(argument.word) + " is not a number; write its value."
                                                    : "one real number belongs here.");
    return 0;
}

}  // namespace tunewright::typed
