function figures(log, folder)
% FIGURES  Draw a flight into PNG files, like the figures of thesis chapter 6.
%
%   quadcore.figures(quadcore.read_log('flight.mat'), 'figures')
%
% Writes path.png, position.png, attitude.png and rotors.png and, for a closed-loop flight, error.png.
  if ~exist(folder, 'dir')
    mkdir(folder);
  end
  p = [log.x(:), log.y(:), log.z(:)];
  wanted = [];
  if isfield(log, 'topic_reference')
    r = log.topic_reference;
    wanted = [r.x(:), r.y(:), r.z(:)];
  end

  h = open_figure();
  plot3(p(:, 1), p(:, 2), p(:, 3));
  if ~isempty(wanted)
    hold on
    plot3(wanted(:, 1), wanted(:, 2), wanted(:, 3), '--');
    legend('flight', 'reference');
  end
  grid on
  xlabel('x (m)'); ylabel('y (m)'); zlabel('z (m)');
  save_figure(h, folder, 'path');

  draw_curves(folder, 'position', log.t, p, wanted, {'x (m)', 'y (m)', 'z (m)'});
  rpy = quadcore.roll_pitch_yaw([log.qx(:), log.qy(:), log.qz(:), log.qw(:)]);
  names = {'roll (deg)', 'pitch (deg)', 'yaw (deg)'};
  draw_curves(folder, 'attitude', log.t, rpy * 180 / pi, [], names);
  names = arrayfun(@(i) sprintf('joint %d (rad/s)', i), 1:size(log.j, 2), 'UniformOutput', false);
  draw_curves(folder, 'rotors', log.t, log.j, [], names);
  if ~isempty(wanted)
    names = {'x error (m)', 'y error (m)', 'z error (m)'};
    draw_curves(folder, 'error', log.t, p - wanted, [], names);
  end
end

function draw_curves(folder, name, t, columns, wanted, names)
  h = open_figure();
  n = size(columns, 2);
  for i = 1:n
    subplot(n, 1, i);
    plot(t, columns(:, i));
    if ~isempty(wanted)
      hold on
      plot(t, wanted(:, i), '--');
    end
    grid on
    ylabel(names{i});
  end
  xlabel('t (s)');
  save_figure(h, folder, name);
end

function h = open_figure()
  h = figure('visible', 'off');
end

function save_figure(h, folder, name)
  print(h, fullfile(folder, [name, '.png']), '-dpng', '-r100');
  close(h);
end
