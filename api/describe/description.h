// A type of the contract, described once: from it follow reading (every fault at once), writing and the JSON Schema.
#pragma once

#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "api/describe/codec.h"

namespace tunewright::api {

struct FieldOptions {
    bool required = false;
    std::string unit = {};     ///< "time", "1/time", "u/y", ... in the user's units
    bool answer_only = false;  ///< accepted and ignored in requests, so that an answer can be sent back
    bool no_default = false;   ///< the sentence states the default; the member's initial value is not it
};

/// `T` default-constructed holds the contract's defaults.
template <class T>
class Description {
public:
    using Check = std::function<void(const Json&, T&, Reader&)>;

    Description(std::string name, std::string sentence) : name_(std::move(name)), sentence_(std::move(sentence)) {}

    /// A member with a fixed value that tells the type: "type": "fopdt". Not `required`: it is what a missing word
    /// stands for.
    Description& tag(std::string field, std::string value, bool required = true) {
        tag_required_ = required;
        tag_field_ = std::move(field);
        tag_value_ = std::move(value);
        names_.insert(names_.begin(), tag_field_);
        return *this;
    }

    /// `Owner` is T or what it extends.
    template <class M, class Owner>
    requires std::is_base_of_v<Owner, T> Description& field(std::string name, M Owner::*member, Codec<M> codec,
                                                            std::string sentence, FieldOptions options = {}) {
        Field out{name, std::move(sentence), options, {}, {}, codec.schema, {}, {}, {}, {}};
        if (codec.read) {
            out.read = [member, read = codec.read](const Json& value, T& target, Reader& reader) {
                read(value, target.*member, reader);
            };
        }
        out.write = [member, write = codec.write](const T& value, Writer& writer) { write(value.*member, writer); };
        if (codec.skip) out.skip = [member, skip = codec.skip](const T& value) { return skip(value.*member); };
        if (codec.undefined)
            out.undefined = [member, undefined = codec.undefined](const T& value) { return undefined(value.*member); };
        if (codec.why) out.why = [member, why = codec.why](const T& value) { return why(value.*member); };
        if (codec.read && !options.required && !options.answer_only && !options.no_default &&
            !(codec.skip && codec.skip(T{}.*member))) {
            Writer initial;
            codec.write(T{}.*member, initial);
            out.initial = initial.take();
        }
        return add(std::move(out));
    }

    /// A member whose meaning depends on its neighbours. `read` may be empty (answers), `write` too (requests).
    Description& field(std::string name, Check read, std::function<void(const T&, Writer&)> write,
                       std::function<Json(SchemaBook&)> schema, std::string sentence, FieldOptions options = {},
                       std::function<bool(const T&)> skip = {}) {
        return add({name,
                    std::move(sentence),
                    options,
                    std::move(read),
                    std::move(write),
                    std::move(schema),
                    std::move(skip),
                    {},
                    {},
                    {}});
    }

    /// A rule over several members; runs when each of them could be read.
    Description& check(Check rule) {
        checks_.push_back(std::move(rule));
        return *this;
    }

    /// A rule over the members' presence: runs always.
    Description& check_presence(Check rule) {
        presence_.push_back(std::move(rule));
        return *this;
    }

    /// A name that is refused with its own sentence instead of "unknown".
    Description& refuse(std::string name, std::string sentence) {
        refused_.emplace_back(std::move(name), std::move(sentence));
        return *this;
    }

    /// Every null figure gets a reason: its own, or the sentence `otherwise`.
    Description& why_null(std::string otherwise) {
        otherwise_ = std::move(otherwise);
        return *this;
    }

    /// Sample of the whole value for the schema.
    Description& example(Json value) {
        example_ = std::move(value);
        return *this;
    }

    const std::string& name() const { return name_; }
    const std::string& tag_value() const { return tag_value_; }

    void read(const Json& value, T& target, Reader& reader) const {
        if (!value.is_object()) return reader.fault(wrong_kind(value, "an object", reader));
        const std::size_t before = reader.count();
        for (const auto& [given, member] : value.items()) check_name(given, reader);
        for (const Field& field : fields_) {
            const auto at = value.find(field.name);
            if (at == value.end()) {
                if (field.options.required)
                    reader.fault_at(field.name, field.name + " is missing; " + first_lower(field.sentence));
            } else if (field.read && !field.options.answer_only) {
                const Reader::At place(reader, field.name);
                field.read(*at, target, reader);
            }
        }
        for (const Check& rule : presence_) rule(value, target, reader);
        if (!reader.clean_since(before)) return;
        for (const Check& rule : checks_) rule(value, target, reader);
    }

    void write(const T& value, Writer& out) const {
        out.begin_object();
        if (!tag_field_.empty()) {
            out.key(tag_field_);
            out.text(tag_value_);
        }
        std::vector<const Field*> undefined;
        for (const Field& field : fields_) {
            if (!field.write || (field.skip && field.skip(value))) continue;
            out.key(field.name);
            field.write(value, out);
            if (!otherwise_.empty() && field.undefined && field.undefined(value)) undefined.push_back(&field);
        }
        if (!undefined.empty()) write_reasons(value, undefined, out);
        out.end_object();
    }

    /// A reference to the component, which is put into the book.
    Json schema(SchemaBook& book) const {
        if (!book.components.contains(name_)) {
            book.components[name_] = nullptr;
            Json built = build_schema(book);
            book.components[name_] = std::move(built);
        }
        return {{"$ref", "#/components/schemas/" + name_}};
    }

private:
    struct Field {
        std::string name, sentence;
        FieldOptions options;
        Check read;
        std::function<void(const T&, Writer&)> write;
        std::function<Json(SchemaBook&)> schema;
        std::function<bool(const T&)> skip;
        std::function<bool(const T&)> undefined;
        std::function<std::string(const T&)> why;
        std::string initial;  ///< the default as JSON text; empty: none
    };

    Description& add(Field field) {
        names_.push_back(field.name);
        fields_.push_back(std::move(field));
        return *this;
    }

    void check_name(const std::string& given, Reader& reader) const {
        for (const auto& [name, sentence] : refused_) {
            if (given == name) return reader.fault_at(given, sentence);
        }
        if (given == "why_null" && !otherwise_.empty()) return;
        for (const std::string& name : names_) {
            if (given == name) return;
        }
        const std::string meant = nearest(given, names_);
        reader.fault_at(
            given, given + " is not a field here; " +
                       (meant.empty() ? "known are " + listed(names_, "and") + "." : "did you mean " + meant + "?"));
    }

    void write_reasons(const T& value, const std::vector<const Field*>& undefined, Writer& out) const {
        out.key("why_null");
        out.begin_object();
        for (const Field* field : undefined) {
            const std::string why = field->why ? field->why(value) : "";
            out.key(field->name);
            out.text(why.empty() ? otherwise_ : why);
        }
        out.end_object();
    }

    Json build_schema(SchemaBook& book) const {
        Json properties = Json::object();
        Json required = Json::array();
        bool reads = false;
        for (const Field& field : fields_) reads = reads || (field.read && !field.options.answer_only);
        if (!tag_field_.empty()) {
            properties[tag_field_] = {{"type", "string"}, {"const", tag_value_}};
            if (tag_required_) required.push_back(tag_field_);
        }
        for (const Field& field : fields_) {
            Json schema = field.schema(book);
            schema["description"] = field.sentence;
            if (!field.options.unit.empty()) schema["x-unit"] = field.options.unit;
            if (!field.initial.empty()) schema["default"] = Json::parse(field.initial);
            if (reads && field.options.answer_only) schema["readOnly"] = true;
            properties[field.name] = std::move(schema);
            if (reads ? field.options.required : !field.skip) required.push_back(field.name);
        }
        if (!otherwise_.empty()) {
            properties["why_null"] = {{"type", "object"},
                                      {"description", "Field -> why it is null."},
                                      {"additionalProperties", {{"type", "string"}}}};
        }
        Json out{
            {"type", "object"}, {"title", name_}, {"description", sentence_}, {"properties", std::move(properties)}};
        if (!required.empty()) out["required"] = std::move(required);
        out["additionalProperties"] = false;
        if (!example_.is_null()) out["examples"] = Json::array({example_});
        return out;
    }

    static std::string first_lower(const std::string& sentence) {
        const std::size_t end = sentence.find('.');
        std::string first = end == sentence.npos ? sentence + "." : sentence.substr(0, end + 1);
        const bool symbol = first.size() > 1 && (first[1] < 'a' || first[1] > 'z');
        return "it is required: " +
               (symbol ? first
                       : std::string(1, static_cast<char>(std::tolower(static_cast<unsigned char>(first[0])))) +
                             first.substr(1));
    }

    std::string name_, sentence_, tag_field_, tag_value_;
    bool tag_required_ = true;
    std::vector<std::string> names_;
    std::vector<Field> fields_;
    std::vector<Check> checks_, presence_;
    std::vector<std::pair<std::string, std::string>> refused_;
    std::string otherwise_;  ///< of null figures; empty: the type has none
    Json example_;
};

/// The codec of a described type. The description must live as long as the program.
template <class T>
Codec<T> object(const Description<T>& description) {
    const Description<T>* what = &description;
    return {[what](const Json& value, T& target, Reader& reader) { what->read(value, target, reader); },
            [what](const T& value, Writer& out) { what->write(value, out); },
            [what](SchemaBook& book) { return what->schema(book); }};
}

/// The same for types that only answers carry.
template <class T>
Codec<T> answer(const Description<T>& description) {
    Codec<T> codec = object(description);
    codec.read = {};
    return codec;
}

}  // namespace tunewright::api
