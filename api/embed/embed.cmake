# Writes FILES (paths below the current folder) as string literals into the C++ source OUTPUT; files.h reads them.
set(content "#include \"api/embed/files.h\"\n\nnamespace tunewright::api {\n\nconst std::vector<EmbeddedFile>& embedded_files() {\n    static const std::vector<EmbeddedFile> files = {\n")
foreach(file ${FILES})
  file(READ ${file} text)
  string(APPEND content "        {\"${file}\", R\"EMBEDDED(${text})EMBEDDED\"},\n")
endforeach()
string(APPEND content "    };\n    return files;\n}\n\n}  // namespace tunewright::api\n")
file(WRITE ${OUTPUT} "${content}")
