function rpy = roll_pitch_yaw(q)
% ROLL_PITCH_YAW  Return roll, pitch and yaw (rad) of quaternions; thesis eq. (2.8).
%
%   rpy = quadcore.roll_pitch_yaw(q)
%
% q: one row qx, qy, qz, qw for each orientation. rpy: one row for each orientation.
  x = q(:, 1); y = q(:, 2); z = q(:, 3); w = q(:, 4);
  sine = max(-1, min(1, 2 * (w .* y - z .* x)));
  rpy = [atan2(2 * (w .* x + y .* z), 1 - 2 * (x .^ 2 + y .^ 2)), ...
         asin(sine), ...
         atan2(2 * (w .* z + x .* y), 1 - 2 * (y .^ 2 + z .^ 2))];
end
