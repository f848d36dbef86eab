"""Where a robot is: localization on a vector map by laser scans and odometry."""
