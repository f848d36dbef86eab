"""Where and since when another localizer was lost, told by our own track and by the scans."""
