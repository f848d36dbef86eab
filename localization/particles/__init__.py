"""What the localizers that carry particles share: motion noise, resampling, the mean pose."""
