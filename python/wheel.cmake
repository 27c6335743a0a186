# What only the wheel needs (scripts/build_wheel): hidden names, where OpenVINO lies, licence texts.
target_link_options(dxslam_python PRIVATE
  -Wl,--version-script=${CMAKE_CURRENT_SOURCE_DIR}/exports.map)
set_target_properties(dxslam_python PROPERTIES
  INSTALL_RPATH "$ORIGIN/../openvino/libs"  # beside us in site-packages
  LINK_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/exports.map)

# Whatever of Debian is inside, as code in the extension or as library beside it; tests/wheel_test.py
# knows if one is missing.
set(DEBIAN_PACKAGES
  libopencv-core-dev libtbb-dev libeigen3-dev nlohmann-json3-dev libxxhash-dev libfmt9 libyaml-cpp0.7
  libpng16-16 libjpeg62-turbo libopenexr-3-1-30 libimath-3-1-29 libzstd1 liblz4-1 libbz2-1.0 libsqlite3-0)
set(LICENCES ${SKBUILD_METADATA_DIR}/licenses)
foreach(PACKAGE ${DEBIAN_PACKAGES})
  install(FILES /usr/share/doc/${PACKAGE}/copyright DESTINATION ${LICENCES}/${PACKAGE} COMPONENT python)
endforeach()
# Named there by their place on a Debian system; the other one, Apache-2.0, is our own licence.
install(FILES /usr/share/common-licenses/MPL-2.0 DESTINATION ${LICENCES} COMPONENT python)
file(GLOB NANOBIND_LICENCE ${nanobind_DIR}/../../nanobind-*.dist-info/licenses/LICENSE)
install(FILES ${NANOBIND_LICENCE} DESTINATION ${LICENCES}/nanobind COMPONENT python)
