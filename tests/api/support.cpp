#include "support.h"
#include "api/openapi/openapi.h"

#include <fstream>
#include <set>
#include <sstream>

#include "tests/test_data.h"

namespace tunewright::api {

std::string detail_at(const std::vector<FieldError>& faults, std::string_view pointer) {
    std::string others = "nothing at " + std::string(pointer) + ", but:";
    for (const FieldError& fault : faults) {
        if (fault.pointer == pointer) return fault.detail;
        others += "\n" + fault.pointer + ": " + fault.detail;
    }
    return others;
}

std::string data_file(const std::string& name) {
    std::ifstream file(test_data(name));
    EXPECT_TRUE(file.good()) << name;
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

std::string request_with(const std::string& members) {
    return R"({"plant": {"type": "fopdt", "K": 2, "T": 10, "L": 3})" + (members.empty() ? "" : ", " + members) + "}";
}

namespace {

class SchemaCheck {
public:
    explicit SchemaCheck(const Json& document) : document_(document) {}

    void check(const Json& value, const Json& schema, const std::string& at) {
        static const std::set<std::string> kKnown = {"$ref",
                                                     "type",
                                                     "enum",
                                                     "const",
                                                     "oneOf",
                                                     "anyOf",
                                                     "not",
                                                     "minimum",
                                                     "maximum",
                                                     "exclusiveMinimum",
                                                     "exclusiveMaximum",
                                                     "maxLength",
                                                     "minItems",
                                                     "maxItems",
                                                     "items",
                                                     "properties",
                                                     "required",
                                                     "additionalProperties",
                                                     "maxProperties",
                                                     "minProperties",
                                                     "propertyNames",
                                                     "title",
                                                     "description",
                                                     "default",
                                                     "examples",
                                                     "readOnly",
                                                     "format",
                                                     "x-unit",
                                                     "x-main",
                                                     "x-draws",
                                                     "x-slider",
                                                     "x-in-place-of",
                                                     "x-written",
                                                     "x-null"};
        for (const auto& [keyword, ignored] : schema.items()) {
            if (!kKnown.contains(keyword))
                fault(at, "the schema has the keyword " + keyword + ", which this check does not know");
        }
        if (schema.contains("$ref")) check(value, resolve(schema["$ref"].get<std::string>()), at);
        if (schema.contains("type")) check_type(value, schema["type"], at);
        if (schema.contains("const") && value != schema["const"]) fault(at, "is not " + schema["const"].dump());
        if (schema.contains("enum") &&
            std::find(schema["enum"].begin(), schema["enum"].end(), value) == schema["enum"].end())
            fault(at, "is not in " + schema["enum"].dump());
        if (schema.contains("not") && SchemaCheck(document_).holds(value, schema["not"]))
            fault(at, "is " + schema["not"].dump());
        if (schema.contains("oneOf")) check_one_of(value, schema["oneOf"], at);
        if (schema.contains("anyOf")) check_any_of(value, schema["anyOf"], at);
        if (value.is_number()) check_number(value.get<double>(), schema, at);
        if (value.is_string() && schema.contains("maxLength") &&
            value.get<std::string>().size() > schema["maxLength"].get<std::size_t>())
            fault(at, "is too long");
        if (value.is_array()) check_array(value, schema, at);
        if (value.is_object()) check_object(value, schema, at);
    }

    bool holds(const Json& value, const Json& schema) {
        check(value, schema, "");
        return faults.empty();
    }

    std::vector<std::string> faults;

private:
    void fault(const std::string& at, const std::string& what) { faults.push_back(at + " " + what); }

    const Json& resolve(const std::string& reference) { return document_.at(Json::json_pointer(reference.substr(1))); }

    static bool is_type(const Json& value, const std::string& type) {
        if (type == "number") return value.is_number();
        if (type == "integer")
            return value.is_number() &&
                   value.get<double>() == static_cast<double>(static_cast<long long>(value.get<double>()));
        if (type == "string") return value.is_string();
        if (type == "boolean") return value.is_boolean();
        if (type == "null") return value.is_null();
        if (type == "array") return value.is_array();
        return type == "object" && value.is_object();
    }

    void check_type(const Json& value, const Json& type, const std::string& at) {
        bool good = false;
        if (type.is_string())
            good = is_type(value, type);
        else
            for (const Json& one : type) good = good || is_type(value, one);
        if (!good) fault(at, "is not " + type.dump());
    }

    void check_any_of(const Json& value, const Json& choices, const std::string& at) {
        for (const Json& choice : choices)
            if (SchemaCheck(document_).holds(value, choice)) return;
        fault(at, "fits none of anyOf");
    }

    void check_one_of(const Json& value, const Json& choices, const std::string& at) {
        int fitting = 0;
        std::string why;
        for (const Json& choice : choices) {
            SchemaCheck one(document_);
            if (one.holds(value, choice))
                ++fitting;
            else if (!one.faults.empty())
                why += "; " + one.faults.front();
        }
        if (fitting != 1) fault(at, "fits " + std::to_string(fitting) + " of oneOf" + why);
    }

    void check_number(double value, const Json& schema, const std::string& at) {
        if (schema.contains("minimum") && value < schema["minimum"].get<double>()) fault(at, "is below the minimum");
        if (schema.contains("maximum") && value > schema["maximum"].get<double>()) fault(at, "is above the maximum");
        if (schema.contains("exclusiveMinimum") && value <= schema["exclusiveMinimum"].get<double>())
            fault(at, "is not above the minimum");
        if (schema.contains("exclusiveMaximum") && value >= schema["exclusiveMaximum"].get<double>())
            fault(at, "is not below the maximum");
    }

    void check_array(const Json& value, const Json& schema, const std::string& at) {
        if (schema.contains("minItems") && value.size() < schema["minItems"].get<std::size_t>())
            fault(at, "has too few elements");
        if (schema.contains("maxItems") && value.size() > schema["maxItems"].get<std::size_t>())
            fault(at, "has too many elements");
        if (!schema.contains("items")) return;
        for (std::size_t i = 0; i < value.size(); ++i) check(value[i], schema["items"], at + "/" + std::to_string(i));
    }

    void check_object(const Json& value, const Json& schema, const std::string& at) {
        if (schema.contains("required")) {
            for (const Json& name : schema["required"]) {
                if (!value.contains(name.get<std::string>())) fault(at, "lacks " + name.get<std::string>());
            }
        }
        if (schema.contains("maxProperties") && value.size() > schema["maxProperties"].get<std::size_t>())
            fault(at, "has too many members");
        if (schema.contains("minProperties") && value.size() < schema["minProperties"].get<std::size_t>())
            fault(at, "has too few members");
        for (const auto& [name, member] : value.items()) {
            if (schema.contains("properties") && schema["properties"].contains(name)) {
                check(member, schema["properties"][name], at + "/" + name);
            } else if (schema.contains("additionalProperties")) {
                const Json& others = schema["additionalProperties"];
                if (others.is_object())
                    check(member, others, at + "/" + name);
                else if (!others.get<bool>())
                    fault(at, "has the undescribed member " + name);
            }
        }
    }

    const Json& document_;
};

}  // namespace

std::vector<std::string> schema_faults(const Json& value, const Json& schema, const Json& document) {
    SchemaCheck check(document);
    check.check(value, schema, "");
    return check.faults;
}

std::vector<std::string> schema_faults(const Json& value, const std::string& component) {
    static const Json document = Json::parse(openapi_json());
    return schema_faults(value, Json{{"$ref", "#/components/schemas/" + component}}, document);
}

}  // namespace tunewright::api
