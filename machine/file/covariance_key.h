// A covariance as a key of a machine file: the lower triangle, row by row.
#pragma once

#include <Eigen/Core>
#include <string>

#include "core/yaml/yaml_map.h"

namespace understudy::machine {

/// One row and column for each of `units`, by which a row is multiplied to come from the file's unit to SI.
/// Throws InputError for another size, and for a matrix that is not positive semi-definite, with what is
/// wrong with it and the command that writes it. `listed`: its size depends on the file, and a schema asks
/// for any.
Eigen::MatrixXd read_covariance(YamlMap& map, const std::string& key, const Eigen::VectorXd& units,
                                const std::string& command, bool listed = false);

/// The key with its matrix, in ten digits, indented as a key of a section. `page` has the order of the rows.
std::string covariance_text(const std::string& key, const Eigen::MatrixXd& covariance,
                            const Eigen::VectorXd& units, const std::string& page);

}  // namespace understudy::machine
