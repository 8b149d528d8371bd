# An engine in a library of its own, moraine_NAME.so, which sees no symbols but its own and shows only what exports.map
# in its folder lists. FOLDER holds its sources; engine.cpp there is the row of the table and not part of it.
function(moraine_engine_library name folder)
  file(GLOB sources CONFIGURE_DEPENDS ${folder}/*.cpp)
  list(FILTER sources EXCLUDE REGEX "/engine\\.cpp$")
  set(exports ${CMAKE_CURRENT_SOURCE_DIR}/${folder}/exports.map)
  add_library(moraine_${name} MODULE ${sources})
  target_link_libraries(moraine_${name} PRIVATE moraine_physics ${ARGN})
  # GCC would mark inline variables as one for the whole process.
  target_compile_options(moraine_${name} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-fno-gnu-unique>)
  target_link_options(moraine_${name} PRIVATE -Wl,-Bsymbolic,--no-undefined,--as-needed -Wl,--version-script=${exports})
  set_target_properties(moraine_${name} PROPERTIES PREFIX "" LINK_DEPENDS ${exports}
                        LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib/moraine)
  install(TARGETS moraine_${name} LIBRARY DESTINATION lib/moraine)
endfunction()
