// Description of a type of the contract; reading (every fault at once), writing and the JSON Schema follow from it.
#pragma once

#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "api/describe/members.h"

namespace tunewright::api {

/// A default-constructed `T` holds the contract's defaults.
template <class T>
class Description {
public:
    using Check = Callable<void(const Json&, T&, Reader&)>;

    Description(std::string_view name, std::string_view sentence) : members_(name, sentence) {}

    /// A member with a fixed value that identifies the type: "type": "fopdt". Not `required`: a missing word means this
    /// type.
    Description& tag(std::string_view field, std::string_view value, bool required = true) {
        members_.tag(field, value, required);
        return *this;
    }

    /// `Owner` is T or one of its base types.
    template <class M, class Owner>
    requires std::is_base_of_v<Owner, T> Description& field(std::string_view name, M Owner::*member, Codec<M> codec,
                                                            std::string_view sentence,
                                                            const FieldOptions& options = {}) {
        members_.add(name, sentence, options, offset_of(initial(), member), codec_of(std::move(codec)),
                     &(initial().*member));
        return *this;
    }

    /// A member whose meaning depends on other members. `read` may be empty (answers), and so may `write` (requests).
    Description& field(std::string_view name, Check read, Callable<void(const T&, Writer&)> write, SchemaOf schema,
                       std::string_view sentence, const FieldOptions& options = {},
                       Callable<bool(const T&)> skip = {}) {
        members_.add(name, sentence, options,
                     codec_of(Codec<T>{std::move(read), std::move(write), std::move(schema), std::move(skip)}));
        return *this;
    }

    /// A rule over several members; checked if each of them could be read.
    Description& check(Check rule) {
        checks_.push_back(std::move(rule));
        return *this;
    }

    /// A rule over the presence of members: always checked.
    Description& check_presence(Check rule) {
        presence_.push_back(std::move(rule));
        return *this;
    }

    /// A name that is refused with a sentence of its own instead of "unknown".
    Description& refuse(std::string_view name, std::string_view sentence) {
        members_.refuse(name, sentence);
        return *this;
    }

    /// Every null figure has a reason: its own, or the sentence `otherwise`.
    Description& why_null(std::string_view otherwise) {
        members_.why_null(otherwise);
        return *this;
    }

    /// An example of the whole value for the schema.
    Description& example(Json value) {
        members_.example(std::move(value));
        return *this;
    }

    const std::string& name() const { return members_.name(); }
    const std::string& tag_value() const { return members_.tag_value(); }
    bool has(std::string_view name) const { return members_.has(name); }  ///< a member has that name

    void read(const Json& value, T& target, Reader& reader) const {
        const std::size_t before = reader.count();
        if (!members_.read(value, &target, reader)) return;
        for (const Check& rule : presence_) rule(value, target, reader);
        if (!reader.clean_since(before)) return;
        for (const Check& rule : checks_) rule(value, target, reader);
    }

    void write(const T& value, Writer& out) const { members_.write(&value, out); }

    /// A reference to the component, which is added to the book.
    Json schema(SchemaBook& book) const { return members_.schema(book); }

private:
    static const T& initial() {
        static const T value{};
        return value;
    }

    Members members_;
    std::vector<Check> checks_, presence_;
};

/// The codec of a described type. The description must live as long as the program.
template <class T>
Codec<T> object(const Description<T>& description) {
    const Description<T>* what = &description;
    return {[what](const Json& value, T& target, Reader& reader) { what->read(value, target, reader); },
            [what](const T& value, Writer& out) { what->write(value, out); },
            [what](SchemaBook& book) { return what->schema(book); }};
}

/// The codec of a described type for answers only.
template <class T>
Codec<T> answer(const Description<T>& description) {
    Codec<T> codec = object(description);
    codec.read = {};
    return codec;
}

}  // namespace tunewright::api
